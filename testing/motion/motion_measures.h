// Measures on dances: how far two are apart, how smooth, how alive, how late, and whether feet
// slide. A JointTrack is a sequence of poses as places of joints; the measures read two of them
// beside each other.
//
// Units/frames: metres, seconds; a track's frames are 1/hz apart. `world` places are in W; `body`
//               places have the hips' place and full rotation removed, which is how errors of
//               predictions are published. Joints are the canonical bones but the hips.
// Ownership:    a track owns its places.
// Threads:      none inside; const use from any.
// Failure:      measures of too few frames are 0; tracks of different rates are our bug.
// Source:       MPJPE: Martinez, Black, Romero, On human motion prediction using recurrent neural
//               networks, CVPR 2017, and who compares with it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

struct JointTrack {
  using Joints = std::array<Eigen::Vector3f, kBoneCount>;

  JointTrack(const Skeleton& skeleton, std::span<const Pose> poses, double hz);
  std::size_t size() const { return world.size(); }

  double hz;
  std::vector<Joints> world;
  std::vector<Joints> body;
  double bone_length_error_m = 0.0;  // the largest: 0 unless a rotation is not unit
};

// Mean distance of the joints of one pose from those of the other, the hips' place and rotation
// removed.
double body_error_m(const Skeleton& skeleton, const Pose& a, const Pose& b);
// The same over frames [from, to) of both.
double body_error_m(const JointTrack& a, const JointTrack& b, std::size_t from, std::size_t to);
double body_error_m(const JointTrack& a, const JointTrack& b);
// Mean distance in W.
double world_error_m(const JointTrack& a, const JointTrack& b, std::size_t from, std::size_t to);

enum class Places { kWorld, kBody };

// Mean size of the third difference of the joints' places, m/s³.
double jerk_m_s3(const JointTrack& track, Places places);
// Mean and largest speed of the joints over frames [from, to), m/s; each is taken from the frame
// before.
double activity_m_s(const JointTrack& track, Places places, std::size_t from, std::size_t to);
double activity_m_s(const JointTrack& track, Places places);
double peak_speed_m_s(const JointTrack& track, Places places, std::size_t from, std::size_t to);

// When the feet stand. A foot stands where its ball (the toes' joint) is slower than 0.15 m/s and
// less than 5 cm above its floor, the lowest twentieth of its heights.
struct Stance {
  std::vector<std::array<bool, 2>> stands;  // by frame: left, right
};
Stance stance_of(const JointTrack& track);
// Mean horizontal speed of the balls of standing feet, m/s. `late`: how many frames the track is
// behind the one whose stance it is. 0 where nothing stands.
double slide_m_s(const JointTrack& track, const Stance& stance, int late = 0);

// By how much the track is behind the truth: the shift with the least mean distance of places
// relative to the hips (turned as they are), within `most`; between frames by a parabola. s,
// positive is late.
double effective_lag_s(const JointTrack& track, const JointTrack& truth, double most_s = 0.5);

// How fast the dance is played: capture times shown at steady steps of 1/hz; 1 is as danced.
struct PlayRate {
  double least = 0.0, mean = 0.0, most = 0.0;
};
PlayRate play_rate(std::span<const Pose> shown, double hz);

}  // namespace dance
