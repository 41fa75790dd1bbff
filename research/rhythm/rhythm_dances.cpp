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

}  // namespace

BeatDance lay_onto_beats(const CodecTake& take, const BeatGrid& music, double hz) {
  BeatDance dance;
  dance.name = take.name;
  dance.skeleton = take.skeleton;
  const JointTrack track(take.skeleton, take.poses, take.hz);
  TakeGrid grid = find_take_grid(track);
  // To music of half or double the tempo dancers dance every second beat, or each twice.
  const double ratio = music.tempo_bpm(music.first_beat() + 4.0) / grid.tempo_bpm;
  grid.tempo_bpm *= std::exp2(std::round(std::log2(ratio)));
  const double shift = std::ceil(music.beat_at(0.0) - grid.beats_at(0.0));
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
