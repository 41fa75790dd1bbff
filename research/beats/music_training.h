// Training of the beat tracker's model from songs whose beats are known: a recurrent network that
// hears beats and tempi (rhythm_net_fit.h), and the patterns of strokes in which the songs' bars
// fall into kinds.
//
// Units/frames: seconds of a song; hops of onset strengths.
// Ownership:    returns a model of its own.
// Threads:      two while it trains; songs may be loaded at the same time. The same songs and seed
//               give the same model.
// Failure:      an Error names the song that cannot be learnt from.
// Source:       k-means with seeds drawn by distance (Arthur and Vassilvitskii, 2007).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "producers/music/tracker/beat_model.h"
#include "research/beats/rhythm_net_fit.h"

namespace dance {

// Mean strength of each group at each slot of a bar, over some bars in a row; the mean over the
// hops is 1.
using BarStrokes = std::array<std::array<float, kPatternSlots>, kOnsetGroups>;

// What a song teaches.
struct TrainingSong {
  std::string name;
  float weight = 1.0f;
  double least_tempo_bpm = 0.0;
  double most_tempo_bpm = 0.0;
  std::vector<BarStrokes> bars;
  RhythmSong rhythm;
};

struct MusicTraining {
  int rounds = 1500;
  int patterns = 16;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> tell = [](const std::string&) {
  };  // progress, a line each
};

// How a song is listened to.
struct HeardAs {
  double speed = 1.0;  // as a record that turns faster
  std::uint64_t studio =
      0;  // which one mastered it (research/beats/song_mastering.h); 0: as the file is
};

Result<TrainingSong> load_training_song(const std::string& audio_path,
                                        const std::string& beats_path, HeardAs heard_as = {});
// Of a song, by its file's name; never 0.
std::uint64_t studio_of(std::string_view file_name, std::size_t way, std::uint64_t seed);
Result<BeatModel> train_beats(const std::vector<const TrainingSong*>& songs,
                              const MusicTraining& training);

// The parts.
std::vector<MeterPattern> fit_patterns(const std::vector<const TrainingSong*>& songs,
                                       const MusicTraining& training);
// Strengths of hops that were heard at hop_times_s, over the beats that begin at beats_s; beats_s
// has one more than a multiple of four.
BarStrokes strokes_of_bars(std::span<const OnsetStrength::Strengths> strengths,
                           std::span<const double> hop_times_s, std::span<const double> beats_s);

}  // namespace dance
