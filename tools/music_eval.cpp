#include "tools/music_eval.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>

#include "core/base/random.h"
#include "producers/music/audio_file.h"
#include "producers/music/beat_tracker.h"
#include "producers/music/beats_file.h"
#include "tools/aubio_beats.h"

namespace dance {
namespace {

constexpr double kLongestSong_s = 3600.0;

Result<std::vector<float>> read_song(AudioFile& file) {
  std::vector<float> samples;
  std::vector<float> block(65536);
  while (static_cast<double>(samples.size()) < kLongestSong_s * file.rate_hz()) {
    DANCE_TRY(const std::size_t n, file.read(block));
    if (n == 0) break;
    samples.insert(samples.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return samples;
}

std::vector<float> change(const std::vector<float>& song, double rate_hz,
                          const MusicEvalOptions& options) {
  const auto gain = static_cast<float>(std::pow(10.0, options.gain_db / 20.0));
  const auto noise = static_cast<float>(std::pow(10.0, options.noise_db / 20.0));
  Random random(1);
  std::vector<float> out;
  for (double at = options.start_s * rate_hz; at + 1.0 < static_cast<double>(song.size());
       at += options.speed) {
    const auto i = static_cast<std::size_t>(at);
    const auto part = static_cast<float>(at - static_cast<double>(i));
    const float sample = song[i] + part * (song[i + 1] - song[i]);
    out.push_back(gain * sample + noise * static_cast<float>(random.uniform(-1.0, 1.0)));
  }
  return out;
}

struct Heard {
  std::vector<double> beats_s;
  std::vector<Beat> words;  // after each hop
  double seconds = 0.0;     // of a core that it took
};

// Others may be busy on the machine.
double core_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Heard hear(std::span<const float> samples, double rate_hz) {
  BeatTracker tracker(rate_hz);
  PredictedBeats beats(static_cast<double>(tracker.hop_samples()) / rate_hz);
  Heard heard;
  heard.words.reserve(samples.size() / tracker.hop_samples());
  const double begin_s = core_seconds();
  for (; samples.size() >= tracker.hop_samples();
       samples = samples.subspan(tracker.hop_samples())) {
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
                                  const std::vector<Beat>& words) {
  std::vector<float> poisoned(song);
  Random random(2);
  for (std::size_t i = poisoned.size() / 2; i < poisoned.size(); ++i)
    poisoned[i] = static_cast<float>(random.uniform(-1.0, 1.0));
  const std::vector<Beat> others = hear(poisoned, rate_hz).words;
  const double half_s = static_cast<double>(poisoned.size() / 2) / rate_hz;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if ((words[k].time - MonoTime{}).as_seconds() > half_s) return true;
    if (words[k].beat_time != others[k].beat_time || words[k].beat != others[k].beat ||
        words[k].tempo_bpm != others[k].tempo_bpm || words[k].confidence != others[k].confidence)
      return false;
  }
  return true;
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
  DANCE_TRY(AudioFile file, AudioFile::open(audio_path));
  const double rate_hz = file.rate_hz();
  if (rate_hz < BeatTracker::kLeastRate_hz || rate_hz > BeatTracker::kMostRate_hz)
    return fail(audio_path + ": has " + std::to_string(static_cast<int>(rate_hz)) +
                " samples a second; the tracker wants 8000 to 200000");
  DANCE_TRY(const BeatGrid grid, read_beats_file(beats_path));
  DANCE_TRY(const std::vector<float> original, read_song(file));
  const std::vector<float> song = change(original, rate_hz, options);
  std::vector<double> truth_s;
  for (double b = grid.first_beat(); b <= grid.last_beat(); b += 1.0)
    truth_s.push_back((grid.time_of(b) - options.start_s) / options.speed);

  SongEval result;
  result.name = std::filesystem::path(audio_path).filename().string();
  const Heard heard = hear(song, rate_hz);
  // Behind the last beat of the list nothing is known.
  const double end_s =
      std::min(static_cast<double>(song.size()) / rate_hz, truth_s.back() + kBeatTolerance_s);
  if (end_s <= options.left_out_s)
    return fail(audio_path + ": is no longer than the " +
                std::to_string(static_cast<int>(options.left_out_s)) + " s that are left out");
  result.score = score_beats(truth_s, heard.beats_s, options.left_out_s, end_s);
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
  result.causal = options.check_causal && says_the_same_without_future(song, rate_hz, heard.words);
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
  if (aubio)
    result.aubio = score_beats(truth_s, *aubio, options.left_out_s, end_s);
  else
    result.aubio_missing = aubio.error().what;
  return result;
}

}  // namespace dance
