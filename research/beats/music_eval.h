// The beat tracker on songs whose beats are known, fed hop by hop as a microphone would feed it,
// beside aubio.
//
// Units/frames: errors are told minus true.
// Ownership:    plain values.
// Threads:      one.
// Failure:      an Error names the file that cannot be read.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/music/tracker/beat_model.h"
#include "research/beats/step_dancers.h"
#include "testing/music/beat_level.h"
#include "testing/music/beat_score.h"

namespace dance {

struct MusicEvalOptions {
  // What the file is changed by first, to see what the tracker hangs on.
  double gain_db = 0.0;
  double noise_db = -200.0;  // of full scale
  double speed = 1.0;        // as a record that turns faster
  double start_s = 0.0;
  double left_out_s = 5.0;  // at the begin
  // The song is heard once more with dancers who step on each beat: their tempo told, with this
  // weight, or measured from the poses of a couple of these takes. Neither: nobody is seen.
  double told_steps_weight = 0.0;
  std::shared_ptr<const StepTakes> dancers;
  std::size_t couple = 0;
  std::shared_ptr<const BeatModel> model = built_in_beat_model();
  bool with_aubio = true;
  bool check_causal = true;  // takes as long again
};

struct SongEval {
  std::string name;
  std::string
      genre;  // of a made song, or as a line `# genre: ` of its .beats file says; else empty
  BeatScore score;
  BeatLevel level;
  double tempo_bpm = 0.0;            // median
  double tempo_error_percent = 0.0;  // median of what each hop's tempo is off by
  // A tracker that hears noise instead of the second half said the same of the first half.
  std::optional<bool> causal;  // unless it was not looked at
  double us_per_hop = 0.0;
  std::optional<BeatScore> with_steps;
  BeatLevel level_with_steps;
  std::optional<BeatScore> aubio;
  BeatLevel aubio_level;
  std::string aubio_missing;  // why there is none
};

Result<SongEval> evaluate_song(const std::string& audio_path, const std::string& beats_path,
                               const MusicEvalOptions& options);

// As a line `# genre: cumbia` of a .beats file says; empty where none does.
std::string genre_of_beats_file(const std::string& path);

// The share of a song's time at a wrong level from which the song counts as one that is.
constexpr double kWrongLevelShare = 0.2;

// By genre and of the recorded songs: how good, and how often at a wrong level; empty where no song
// has a genre.
std::string music_eval_genres(const std::vector<SongEval>& songs);
std::string music_eval_table(const std::vector<SongEval>& songs);
std::string music_eval_json(const std::vector<SongEval>& songs);

}  // namespace dance
