#include "research/beats/music_eval.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>

#include "core/base/random.h"
#include "producers/music/beats_file.h"
#include "producers/music/tracker/beat_tracker.h"
#include "research/beats/aubio_beats.h"
#include "research/beats/music_samples.h"

namespace dance {
namespace {

std::vector<float> change(const std::vector<float>& song, double rate_hz,
                          const MusicEvalOptions& options) {
  const auto gain = gain_of_db(options.gain_db);
  const auto noise = gain_of_db(options.noise_db);
  Random random(1);
  std::vector<float> out = turned(song, options.speed, options.start_s * rate_hz);
  for (float& x : out) x = gain * x + noise * static_cast<float>(random.uniform(-1.0, 1.0));
  return out;
}

struct Heard {
  std::vector<double> beats_s;
  std::vector<Beat> words;  // after each hop
  double seconds = 0.0;     // of a core that it took
};

// Others may be busy on the machine, and in this program.
double core_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// What dancers say after what the tracker said last; nothing: nobody is seen.
using HintAfter = std::function<TempoHint(const Beat&)>;

Heard hear(std::span<const float> samples, double rate_hz,
           const std::shared_ptr<const BeatModel>& model, const HintAfter& hint_after = {}) {
  BeatTracker tracker(rate_hz, model);
  PredictedBeats beats(static_cast<double>(tracker.hop_samples()) / rate_hz);
  Heard heard;
  heard.words.reserve(samples.size() / tracker.hop_samples());
  const double begin_s = core_seconds();
  for (; samples.size() >= tracker.hop_samples();
       samples = samples.subspan(tracker.hop_samples())) {
    if (hint_after) tracker.set_tempo_hint(hint_after(tracker.beat()));
    tracker.push(samples.first(tracker.hop_samples()));
    beats.hear(tracker.beat());
    heard.words.push_back(tracker.beat());
  }
  heard.seconds = core_seconds() - begin_s;
  heard.beats_s = beats.times_s();
  return heard;
}

// A strict look: bitwise, with the future replaced by loud noise.
bool says_the_same_without_future(const std::vector<float>& song, double rate_hz,
                                  const std::vector<Beat>& words,
                                  const std::shared_ptr<const BeatModel>& model) {
  std::vector<float> poisoned(song);
  Random random(2);
  for (std::size_t i = poisoned.size() / 2; i < poisoned.size(); ++i)
    poisoned[i] = static_cast<float>(random.uniform(-1.0, 1.0));
  const std::vector<Beat> others = hear(poisoned, rate_hz, model).words;
  const double half_s = static_cast<double>(poisoned.size() / 2) / rate_hz;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if ((words[k].time - MonoTime{}).as_seconds() > half_s) return true;
    if (words[k].beat_time != others[k].beat_time || words[k].beat != others[k].beat ||
        words[k].tempo_bpm != others[k].tempo_bpm || words[k].confidence != others[k].confidence)
      return false;
  }
  return true;
}

HintAfter steps_of(const BeatGrid& grid, const MusicEvalOptions& options) {
  if (options.dancers) {
    const auto dancers = std::make_shared<StepDancers>(*options.dancers, options.couple);
    return [&grid, &options, dancers](const Beat& told) {
      dancers->dance_until((told.time - MonoTime{}).as_seconds(), grid, options.speed,
                           options.start_s, told);
      return dancers->hint();
    };
  }
  if (options.told_steps_weight <= 0.0) return {};
  return [&grid, &options](const Beat& told) {
    const double t = (told.time - MonoTime{}).as_seconds();
    const double beat = grid.beat_at(t * options.speed + options.start_s);
    return TempoHint{grid.tempo_bpm(beat) * options.speed, options.told_steps_weight};
  };
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Result<SongEval> evaluate_song(const std::string& audio_path, const std::string& beats_path,
                               const MusicEvalOptions& options) {
  DANCE_TRY(const MusicSamples original, read_music_samples(audio_path));
  const double rate_hz = original.rate_hz;
  DANCE_TRY(const BeatGrid grid, read_beats_file(beats_path));
  const std::vector<float> song = change(original.samples, rate_hz, options);
  std::vector<double> truth_s;
  for (double b = grid.first_beat(); b <= grid.last_beat(); b += 1.0)
    truth_s.push_back((grid.time_of(b) - options.start_s) / options.speed);

  SongEval result;
  result.name = std::filesystem::path(audio_path).filename().string();
  const Heard heard = hear(song, rate_hz, options.model);
  // Behind the last beat of the list nothing is known.
  const double end_s =
      std::min(static_cast<double>(song.size()) / rate_hz, truth_s.back() + kBeatTolerance_s);
  if (end_s <= options.left_out_s)
    return fail(audio_path + ": is no longer than the " +
                std::to_string(static_cast<int>(options.left_out_s)) + " s that are left out");
  result.genre = genre_of_beats_file(beats_path);
  result.score = score_beats(truth_s, heard.beats_s, options.left_out_s, end_s);
  result.level = level_of_beats(truth_s, heard.beats_s, options.left_out_s, end_s);
  if (const HintAfter steps = steps_of(grid, options)) {
    const Heard other = hear(song, rate_hz, options.model, steps);
    result.with_steps = score_beats(truth_s, other.beats_s, options.left_out_s, end_s);
    result.level_with_steps = level_of_beats(truth_s, other.beats_s, options.left_out_s, end_s);
  }
  std::vector<double> tempi;
  std::vector<double> errors;
  for (const Beat& word : heard.words) {
    const double t = (word.time - MonoTime{}).as_seconds();
    if (t < options.left_out_s || t > end_s) continue;
    const double true_bpm =
        grid.tempo_bpm(grid.beat_at(t * options.speed + options.start_s)) * options.speed;
    tempi.push_back(word.tempo_bpm);
    errors.push_back(100.0 * std::abs(word.tempo_bpm / true_bpm - 1.0));
  }
  result.tempo_bpm = median_of(tempi);
  result.tempo_error_percent = median_of(errors);
  if (options.check_causal)
    result.causal = says_the_same_without_future(song, rate_hz, heard.words, options.model);
  result.us_per_hop =
      heard.words.empty() ? 0.0 : heard.seconds * 1e6 / static_cast<double>(heard.words.size());

  if (!options.with_aubio) {
    result.aubio_missing = "aubio was not asked";
    return result;
  }
  if (options.speed != 1.0 || options.start_s != 0.0 || options.gain_db != 0.0 ||
      options.noise_db > -200.0) {
    result.aubio_missing = "aubio hears files as they are: nothing to compare a changed one with";
    return result;
  }
  const auto aubio = aubio_beats(audio_path);
  if (aubio) {
    result.aubio = score_beats(truth_s, *aubio, options.left_out_s, end_s);
    result.aubio_level = level_of_beats(truth_s, *aubio, options.left_out_s, end_s);
  } else {
    result.aubio_missing = aubio.error().what;
  }
  return result;
}

}  // namespace dance
