#include "research/beats/music_training.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/random.h"
#include "producers/music/beats_file.h"
#include "research/beats/music_samples.h"
#include "research/beats/song_mastering.h"

namespace dance {
namespace {

// Means are not settled before.
constexpr std::size_t kFirstMoment_hops = 100;
constexpr double kOnBeat_s = 0.0151;
constexpr double kBesideBeat_s = 0.035;
constexpr float kBesideWeight = 0.3f;
constexpr std::size_t kChunk_beats = 16;
constexpr std::size_t kFirstChunk_beat = 8;
constexpr std::size_t kFewestBeats = kFirstChunk_beat + kChunk_beats + 1;
// Strokes show in a hop that ends so much later; the line of beats is later than that by what it
// takes to follow.
constexpr double kStrokeDelay_s = 0.014;

struct Moment {
  std::size_t kind = 2;
  float weight = 1.0f;
};

// What lies at t between two beats.
Moment moment_at(double t, double beat_s, double next_s) {
  const double to_beat_s = std::min(t - beat_s, next_s - t);
  const double to_half_s = std::abs(t - 0.5 * (beat_s + next_s));
  if (to_beat_s < kOnBeat_s) return {0, 1.0f};
  if (to_half_s < kOnBeat_s) return {1, 1.0f};
  return {2, std::min(to_beat_s, to_half_s) < kBesideBeat_s ? kBesideWeight : 1.0f};
}

void find_tempi(TrainingSong& song, std::span<const double> beats_s) {
  std::vector<double> tempi;
  for (std::size_t i = 0; i + 1 < beats_s.size(); ++i)
    tempi.push_back(60.0 / (beats_s[i + 1] - beats_s[i]));
  std::sort(tempi.begin(), tempi.end());
  song.least_tempo_bpm = tempi[tempi.size() / 50];
  song.most_tempo_bpm = tempi[tempi.size() - 1 - tempi.size() / 50];
}

void find_bars(TrainingSong& song, std::span<const OnsetStrength::Strengths> strengths,
               std::span<const double> times_s, std::span<const double> beats_s) {
  for (std::size_t k = kFirstChunk_beat; k + kChunk_beats < beats_s.size(); k += kChunk_beats) {
    const auto hop = [&](double t) {
      return static_cast<std::size_t>(std::lower_bound(times_s.begin(), times_s.end(), t - 0.04) -
                                      times_s.begin());
    };
    const std::size_t first = hop(beats_s[k]);
    const std::size_t end = hop(beats_s[k + kChunk_beats]);
    if (end >= times_s.size()) return;
    song.bars.push_back(strokes_of_bars(strengths.subspan(first, end - first),
                                        times_s.subspan(first, end - first),
                                        beats_s.subspan(k, kChunk_beats + 1)));
  }
}

}  // namespace

std::uint64_t studio_of(std::string_view file_name, std::size_t way, std::uint64_t seed) {
  std::uint64_t studio = Random(seed).next_u64();
  const auto mix = [&](std::uint64_t x) { studio = Random(studio ^ x).next_u64(); };
  mix(way);
  for (const char c : file_name) mix(static_cast<unsigned char>(c));
  return std::max<std::uint64_t>(studio, 1);
}

Result<TrainingSong> load_training_song(const std::string& audio_path,
                                        const std::string& beats_path, HeardAs heard_as) {
  DANCE_TRY(const BeatGrid grid, read_beats_file(beats_path));
  DANCE_TRY(const MusicSamples music, read_music_samples(audio_path));
  std::vector<float> samples = turned(music.samples, heard_as.speed);
  if (heard_as.studio != 0) samples = mastered(std::move(samples), music.rate_hz, heard_as.studio);
  std::vector<double> beats_s;
  for (double b = grid.first_beat(); b <= grid.last_beat(); b += 1.0)
    beats_s.push_back(grid.time_of(b) / heard_as.speed);
  if (beats_s.size() < kFewestBeats)
    return fail(beats_path + ": has " + std::to_string(beats_s.size()) + " beats, but " +
                std::to_string(kFewestBeats) + " are needed to learn from");

  TrainingSong song;
  song.name = std::filesystem::path(audio_path).filename().string();
  find_tempi(song, beats_s);
  OnsetStrength onsets(music.rate_hz);
  RhythmFeatures features(onsets);
  const double hop_s = static_cast<double>(onsets.hop_samples()) / music.rate_hz;
  std::vector<OnsetStrength::Strengths> strengths;
  std::vector<double> times_s;
  std::array<float, 3> sums{};
  std::size_t beat = 0;
  RhythmSong& rhythm = song.rhythm;
  for (std::span<const float> left(samples); left.size() >= onsets.hop_samples();
       left = left.subspan(onsets.hop_samples())) {
    strengths.push_back(onsets.push(left.first(onsets.hop_samples())));
    const bool is_step = features.push(onsets, strengths.back());
    const double now_s = static_cast<double>(strengths.size()) * hop_s;
    times_s.push_back(now_s - kStrokeDelay_s);
    if (!is_step) continue;
    const double t = now_s - RhythmNet::kDelay_s;
    while (beat + 1 < beats_s.size() && beats_s[beat + 1] <= t) ++beat;
    Moment moment{2, 0.0f};
    if (t >= beats_s[beat] && beat + 1 < beats_s.size())
      moment = moment_at(t, beats_s[beat], beats_s[beat + 1]);
    if (strengths.size() < kFirstMoment_hops) moment.weight = 0.0f;
    const auto values = features.values();
    rhythm.features.insert(rhythm.features.end(), values.begin(), values.end());
    rhythm.classes.push_back(static_cast<std::uint8_t>(moment.kind));
    rhythm.weights.push_back(moment.weight);
    const double beat_s = beat + 1 < beats_s.size() ? beats_s[beat + 1] - beats_s[beat] : 1.0;
    rhythm.tempi.push_back(static_cast<float>(RhythmNet::place_of_tempo(60.0 / beat_s)));
    sums[moment.kind] += moment.weight;
  }
  // Each class weighs the same, so that answers are ratios of likelihoods; a step weighs 1 in the
  // mean.
  for (std::size_t i = 0; i < rhythm.weights.size(); ++i)
    rhythm.weights[i] *= static_cast<float>(rhythm.weights.size()) /
                         (3.0f * std::max(sums[rhythm.classes[i]], 1.0f));
  find_bars(song, strengths, times_s, beats_s);
  if (song.bars.empty() || rhythm.classes.empty())
    return fail(audio_path + ": ends before its beats do: nothing can be learnt from it");
  return song;
}

Result<BeatModel> train_beats(const std::vector<const TrainingSong*>& songs,
                              const MusicTraining& training) {
  if (songs.empty()) return fail("no song to learn from");
  BeatModel model;
  model.patterns = fit_patterns(songs, training);
  if (model.patterns.empty())
    return fail(
        "no kind of bar is left to learn: the songs' beats are slower or faster than what is "
        "looked for, 72 to 214 a "
        "minute (give a slow song's at their double), or --patterns asks for more kinds than the "
        "songs have");
  std::vector<WeightedRhythm> rhythms;
  for (const TrainingSong* song : songs) rhythms.push_back({&song->rhythm, song->weight});
  model.net = fit_rhythm_net(
      rhythms, {.rounds = training.rounds, .seed = training.seed, .tell = training.tell});
  return model;
}

}  // namespace dance
