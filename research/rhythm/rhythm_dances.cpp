#include <cmath>

#include "core/pose/interpolate.h"
#include "producers/salsa/salsa_dancer.h"
#include "research/rhythm/rhythm_eval.h"
#include "testing/motion/take_grid.h"

namespace dance {
namespace {

void tag(Pose& pose, std::uint32_t sequence, double t_s, double beats) {
  pose.sequence = sequence;
  pose.clock_id = 1;
  pose.capture_time = kRhythmEvalBegin + Duration::seconds(t_s);
  pose.music_beats = beats;
}

// To music of half or double the tempo dancers dance every second beat, or each twice.
double rate_to(const BeatGrid& music, double tempo_bpm) {
  return std::exp2(std::round(std::log2(music.tempo_bpm(music.first_beat() + 4.0) / tempo_bpm)));
}

// Grid: beats_at() and time_of() of the take's own time.
template <typename Grid>
BeatDance lay(const CodecTake& take, const Grid& grid, double whole_beats, const BeatGrid& music,
              double hz) {
  BeatDance dance;
  dance.name = take.name;
  dance.skeleton = take.skeleton;
  const double shift =
      whole_beats * std::ceil((music.beat_at(0.0) - grid.beats_at(0.0)) / whole_beats);
  const double last_s = static_cast<double>(take.poses.size() - 1) / take.hz;
  for (std::uint32_t i = 0;; ++i) {
    const double t_s = i / hz;
    const double beats = music.beat_at(t_s);
    const double take_s = grid.time_of(beats - shift);
    if (take_s < 0.0) {
      // The take begins a little after the music: its first pose waits.
      dance.poses.push_back(take.poses.front());
    } else {
      if (take_s >= last_s) break;
      const double frame = take_s * take.hz;
      const auto whole = static_cast<std::size_t>(frame);
      dance.poses.push_back(interpolate(take.poses[whole], take.poses[whole + 1],
                                        static_cast<float>(frame - std::floor(frame))));
    }
    tag(dance.poses.back(), i, t_s, beats);
    dance.beats.push_back(beats);
  }
  return dance;
}

}  // namespace

BeatDance lay_onto_beats(const CodecTake& take, const BeatGrid& music, double hz) {
  const JointTrack track(take.skeleton, take.poses, take.hz);
  TakeGrid grid = find_take_grid(track);
  grid.tempo_bpm *= rate_to(music, grid.tempo_bpm);
  return lay(take, grid, 1.0, music, hz);
}

BeatDance lay_onto_beats(const CodecTake& take, const DanceBeats& beats, const BeatGrid& music,
                         double hz) {
  struct Faster {
    const DanceBeats& beats;
    double rate;
    double beats_at(double t_s) const { return rate * beats.beats_at(t_s); }
    double time_of(double b) const { return beats.time_of(b / rate); }
  };
  // Whole bars, so that the first of a bar is danced on the first of a bar.
  return lay(take, Faster{beats, rate_to(music, beats.tempo_bpm)}, 4.0, music, hz);
}

BeatDance salsa_to_music(SalsaRole role, std::uint64_t seed, double tempo_bpm, Duration length,
                         const BeatGrid& music, double hz) {
  SalsaStyle style;
  style.role = role;
  style.seed = seed;
  SalsaDancer dancer(style);
  BeatDance dance;
  dance.name = role == SalsaRole::kLead ? "synthetic lead" : "synthetic follow";
  dance.skeleton = dancer.skeleton();
  const auto frames = static_cast<std::uint32_t>(length.as_seconds() * hz);
  for (std::uint32_t i = 0; i < frames; ++i) {
    const double t_s = i / hz, heard = music.beat_at(t_s);
    const double danced = tempo_bpm > 0.0 ? t_s * tempo_bpm / 60.0 : heard;
    Pose pose;
    dancer.dance_at(Duration::seconds(danced * 60.0 / style.tempo_bpm), pose);
    tag(pose, i, t_s, heard);
    dance.poses.push_back(pose);
    dance.beats.push_back(danced);
  }
  return dance;
}

}  // namespace dance
