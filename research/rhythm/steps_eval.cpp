#include "research/rhythm/steps_eval.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/base/random.h"
#include "transformers/rhythm/own_beat.h"
#include "transformers/tempo/motion_beats.h"

namespace dance {
namespace {

constexpr float kTrusted = 0.6f;  // coherence of the period, as its header advises
constexpr double kBar_beats = 4.0;

double folded(double value, double period) { return value - period * std::round(value / period); }

Pose untagged(Pose pose) {
  pose.music_beats = kNoMusic;
  return pose;
}

std::string score_text(const StepsScore& score) {
  if (score.known <= 0.0) return fmt::format("{:>6.0f}%{:>22}", 0.0, "");
  return fmt::format("{:>6.0f}% {:>+6.0f} {:>5.0f} {:>7.0f}%", 100.0 * score.known, score.mean_ms,
                     score.sd_ms, 100.0 * score.same_beat);
}

// Each dance counts as much as is known of it.
StepsScore mean_of(const std::vector<StepsRow>& rows, StepsScore StepsRow::*which) {
  StepsScore mean;
  double weights = 1e-12, square = 0.0;
  for (const StepsRow& row : rows) {
    const StepsScore& s = row.*which;
    weights += s.known;
    mean.known += s.known / static_cast<double>(rows.size());
    mean.mean_ms += s.known * s.mean_ms;
    mean.same_beat += s.known * s.same_beat;
    square += s.known * s.sd_ms * s.sd_ms;
  }
  mean.mean_ms /= weights;
  mean.same_beat /= weights;
  mean.sd_ms = std::sqrt(square / weights);
  return mean;
}

std::string line(const StepsRow& row) {
  return fmt::format("{:<26} {:>+6.0f} {} | {} | {}\n", row.name, row.stands_ms,
                     score_text(row.period), score_text(row.ours), score_text(row.others_steps));
}

}  // namespace

ToldBeats told_by_steps(const BeatDance& dance, double music_bpm, const StepPattern& pattern) {
  OwnBeat own(pattern);
  own.set_body(dance.skeleton);
  ToldBeats told;
  for (const Pose& pose : dance.poses)
    told.push_back(own.observe(untagged(pose), pose.capture_time, music_bpm));
  return told;
}

ToldBeats told_by_period(const BeatDance& dance, double music_bpm) {
  Period period;
  period.set_body(dance.skeleton);
  period.set_tempo(music_bpm);
  ToldBeats told;
  for (const Pose& pose : dance.poses) {
    period.observe(untagged(pose), pose.capture_time);
    const bool is_known =
        period.is_known() && period.is_anchored() && period.coherence() > kTrusted;
    told.push_back(is_known ? std::optional(period.count(pose.capture_time)) : std::nullopt);
  }
  return told;
}

StepsScore steps_score(const BeatDance& dance, const ToldBeats& told, double music_bpm) {
  StepsScore score;
  std::vector<double> late;
  std::complex<double> circle;
  double same = 0.0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!told[i]) continue;
    // At each beat is shown what is told to be danced at it: a dancer of whom too much is told is
    // shown late.
    const double beats = *told[i] - dance.beats[i];
    late.push_back(beats);
    circle += std::polar(1.0, 2.0 * std::numbers::pi * beats);
    same += std::abs(folded(beats, kBar_beats)) < 0.5 ? 1.0 : 0.0;
  }
  if (late.empty()) return score;
  const auto n = static_cast<double>(late.size());
  const double beat_ms = 60e3 / music_bpm;
  const double mean = std::arg(circle) / (2.0 * std::numbers::pi);
  double square = 0.0;
  for (const double beats : late) square += std::pow(folded(beats - mean, 1.0), 2.0) / n;
  score.known = n / static_cast<double>(told.size());
  score.mean_ms = mean * beat_ms;
  score.sd_ms = std::sqrt(square) * beat_ms;
  score.same_beat = same / n;
  return score;
}

double feet_stand_ms(const BeatDance& dance, double music_bpm) {
  constexpr float kSwung_m_s = 0.8f;
  MotionChannels channels;
  channels.set_body(dance.skeleton);
  MotionBeats beats;
  std::complex<double> circle;
  for (std::size_t i = 0; i < dance.poses.size(); ++i) {
    const MonoTime now = dance.poses[i].capture_time;
    const std::size_t count = beats.add(channels.take(untagged(dance.poses[i])));
    for (std::size_t k = 0; k < count; ++k) {
      const MotionBeat& beat = beats.newest(k);
      if (!beat.is_foot_fall() || beat.strength < kSwung_m_s) continue;
      const double at = dance.beats[i] - (now - beat.time).as_seconds() * music_bpm / 60.0;
      circle += std::polar(1.0, 2.0 * std::numbers::pi * at);
    }
  }
  return std::arg(circle) / (2.0 * std::numbers::pi) * 60e3 / music_bpm;
}

BeatDance shuffled(const BeatDance& dance, std::uint64_t seed) {
  constexpr std::size_t kPart = 60;
  std::vector<std::size_t> parts(dance.poses.size() / kPart);
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = i;
  Random random(seed);
  for (std::size_t i = parts.size(); i > 1; --i)
    std::swap(parts[i - 1], parts[std::min(i - 1, static_cast<std::size_t>(random.uniform(
                                                      0.0, static_cast<double>(i))))]);
  BeatDance other;
  other.name = "shuffled";
  other.skeleton = dance.skeleton;
  for (std::size_t i = 0; i < parts.size() * kPart; ++i) {
    other.poses.push_back(dance.poses[parts[i / kPart] * kPart + i % kPart]);
    other.poses.back().capture_time = dance.poses[i].capture_time;
    other.beats.push_back(dance.beats[i]);
  }
  return other;
}

BeatDance standing(const BeatDance& dance, std::uint64_t seed) {
  BeatDance other = dance;
  other.name = "standing";
  Random random(seed);
  for (Pose& pose : other.poses) {
    const MonoTime t = pose.capture_time;
    pose = dance.poses.front();
    pose.capture_time = t;
    // As a camera sees somebody who stands.
    for (auto& R : pose.R_PB) {
      const auto noise = [&] { return static_cast<float>(random.uniform(-0.01, 0.01)); };
      R = R * Eigen::Quaternionf(1.0f, noise(), noise(), noise()).normalized();
    }
  }
  return other;
}

std::string steps_table(const std::vector<StepsRow>& rows, const std::vector<StepsRow>& none) {
  const std::string columns = fmt::format("{:>7} {:>6} {:>5} {:>8}", "known", "late", "sd", "of 4");
  std::string text =
      "\nmusical time from steps alone\n" +
      fmt::format("{:<26} {:>6} {:^29} | {:^29} | {:^29}\n", "", "feet", "the period alone",
                  "as it is", "steps learnt from others") +
      fmt::format("{:<26} {:>6} {} | {} | {}\n", "", "stand", columns, columns, columns);
  for (const StepsRow& row : rows) text += line(row);
  const auto mean = [](const char* name, const std::vector<StepsRow>& of) {
    double stands_ms = 0.0;
    for (const StepsRow& row : of) stands_ms += row.stands_ms / static_cast<double>(of.size());
    return StepsRow{name, stands_ms, mean_of(of, &StepsRow::period), mean_of(of, &StepsRow::ours),
                    mean_of(of, &StepsRow::others_steps)};
  };
  if (!rows.empty()) text += line(mean("all", rows));
  for (const StepsRow& row : none)
    text += fmt::format("{:<26}        {:>6.0f}%{:>22} | {:>6.0f}%{:>22} | {:>6.0f}%\n", row.name,
                        100.0 * row.period.known, "", 100.0 * row.ours.known, "",
                        100.0 * row.others_steps.known);
  text +=
      "feet stand: ms after the beat; known: share of the dance, from its first pose on; late, sd: "
      "ms, folded to a beat; of 4: "
      "on\n"
      "the right one of four beats. The last rows do not dance to it: known is wrong there.\n";
  return text;
}

}  // namespace dance
