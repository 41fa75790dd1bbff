#include "research/rhythm/untagged_takes.h"

#include <fmt/format.h>

#include <cmath>

#include "research/rhythm/steps_eval.h"

namespace dance {
namespace {

// Of each dancer: weaker moments are figures in which nobody steps, and teach nothing.
constexpr double kLeastStrength = 1.1;

StepPattern learn_without(const std::vector<UntaggedTake>& takes, std::size_t without) {
  std::vector<KnownDance> dances;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    if (without < takes.size() && (i == without || i == takes[without].partner)) continue;
    const double dancers = takes[i].partner == i ? 1.0 : 2.0;
    dances.push_back({&takes[i].steps, &takes[i].beats, dancers * kLeastStrength});
  }
  return learn_steps(dances, salsa_steps());
}

}  // namespace

Result<std::vector<UntaggedTake>> load_untagged_takes(const std::vector<std::string>& files,
                                                      bool couples, double hz) {
  if (couples && files.size() % 2 != 0)
    return fail("--couples: the second half of the files are the partners of the first half");
  std::vector<UntaggedTake> takes;
  for (const std::string& file : files) {
    UntaggedTake untagged;
    DANCE_TRY(untagged.take, load_codec_take(file, hz));
    untagged.steps = steps_of(untagged.take.skeleton, untagged.take.poses, untagged.take.hz);
    if (untagged.steps.size() < 100) return fail(file + " is shorter than ten seconds");
    untagged.alone = find_dance_beats(std::span(&untagged.steps, 1));
    untagged.beats = untagged.alone;
    untagged.partner = takes.size();
    takes.push_back(std::move(untagged));
  }
  for (std::size_t lead = 0; couples && lead < takes.size() / 2; ++lead) {
    const std::size_t follow = lead + takes.size() / 2;
    const std::array<SeenSteps, 2> both{takes[lead].steps, takes[follow].steps};
    takes[lead].beats = takes[follow].beats = find_dance_beats(both);
    takes[lead].partner = follow;
    takes[follow].partner = lead;
  }
  for (std::size_t i = 0; i < takes.size(); ++i) takes[i].others = learn_without(takes, i);
  return takes;
}

StepPattern learn_from_all(const std::vector<UntaggedTake>& takes,
                           const std::vector<BeatDance>& dances, const BeatGrid& music) {
  StepPattern pattern = learn_without(takes, takes.size());
  const double music_bpm = music.tempo_bpm(music.first_beat() + 4.0);
  double late_ms = 0.0, known = 1e-9;
  for (std::size_t i = takes.size(); i < dances.size(); ++i) {
    const StepsScore score =
        steps_score(dances[i], told_by_steps(dances[i], music_bpm, pattern), music_bpm);
    late_ms += score.known * score.mean_ms;
    known += score.known;
  }
  pattern.bring_forward(late_ms / known * music_bpm / 60e3);
  return pattern;
}

std::string partners_table(const std::vector<UntaggedTake>& takes) {
  std::string text =
      fmt::format("\nbeats of the takes by their steps\n{:<26} {:>6} {:>7} {:>8} {:>8} {:>5}\n", "",
                  "BPM", "partner", "together", "apart ms", "sd");
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const UntaggedTake& take = takes[i];
    const DanceBeats &alone = take.alone, &other = takes[take.partner].alone;
    text += fmt::format("{:<26} {:>6.0f} {:>7.0f} {:>8.0f}", take.take.name, alone.tempo_bpm,
                        other.tempo_bpm, take.beats.tempo_bpm);
    double n = 0.0, sum = 0.0, square = 0.0;
    const double last_s = DanceBeats::kEvery_s * static_cast<double>(take.beats.strength.size());
    for (double t_s = 0.0; t_s < last_s; t_s += DanceBeats::kEvery_s) {
      if (alone.strength_at(t_s) < kLeastStrength || other.strength_at(t_s) < kLeastStrength)
        continue;
      double off = alone.beats_at(t_s) - other.beats_at(t_s);
      off -= 4.0 * std::round(off / 4.0);
      n += 1.0;
      sum += off;
      square += off * off;
    }
    const double beat_ms = 60e3 / take.beats.tempo_bpm;
    if (n > 0.0 && take.partner != i)
      text += fmt::format(" {:>+8.0f} {:>5.0f}", sum / n * beat_ms,
                          std::sqrt(std::max(0.0, square / n - sum * sum / (n * n))) * beat_ms);
    text += "\n";
  }
  return text + "apart: the dancer's own beats after the partner's, where both step.\n";
}

std::string pattern_text(const StepPattern& pattern) {
  std::string text;
  const auto put = [&](const char* name, std::span<const float> values) {
    text += fmt::format("{}:", name);
    for (const float value : values) text += fmt::format(" {:.3f}f,", value);
    text += "\n";
  };
  constexpr std::array<const char*, StepPattern::kSigns> kNames{"foot", "", "sway", "higher foot",
                                                                "bounce"};
  for (std::size_t s = 0; s < StepPattern::kSigns; ++s) {
    if (s == StepPattern::kRightFoot) continue;
    std::vector<float> values;
    for (const std::complex<float>& w : pattern.wave[s]) {
      values.push_back(w.real());
      values.push_back(w.imag());
    }
    put(kNames[s], values);
  }
  put("spread", pattern.spread);
  put("power", pattern.power);
  return text;
}

}  // namespace dance
