// Facing: where a body faces, about the vertical. A network that sees a back may take it for a
// front and turn the body half round in one picture. FlipWatch refuses such a turn unless it
// lasts; FacingLimit turns what is shown no faster than a body turns.
//
// Units/frames: radians about W's y, 0 looks along +z; seconds.
// Ownership:    plain values, no heap.
// Threads:      none inside; one owner.
// Failure:      a body that lies, or turns one side up, faces nowhere; nothing is then refused, and
//               the shown turn ends at a body's speed.
// Source:       fastest turns of dancers: CMU motion capture, subjects 60, 61 and 131
//               (`dance capture solve eval --shown`).
#pragma once

#include <optional>

#include "core/pose/kinematics.h"
#include "producers/camera/solver/body_model.h"
#include "producers/camera/solver/camera_placement.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// Of hips and shoulders, right to left.
std::optional<double> facing_of(const Eigen::Vector3d& hips, const Eigen::Vector3d& shoulders);
std::optional<double> facing_of(const BodyModel& body);
std::optional<double> facing_of(const Skeleton& skeleton, const Pose& pose);
// Turns a pose about the vertical through its hips.
void turn_about_vertical(double angle_rad, Pose& pose);
// From one facing to another, the short way; 0 where either is unknown.
double turn_between(const std::optional<double>& from_rad, const std::optional<double>& to_rad);
// Of the network's points in space; none where hips or shoulders are hidden.
std::optional<double> facing_of(const Observation& seen, const Eigen::Matrix3d& R_WC);

// Left and right exchanged.
void exchange_sides(Observation& seen);
// The same picture with sides exchanged, with depth reversed or with both, where the body's
// vectors then are much more alike to those of `expected`; none where they are not.
std::optional<Observation> without_flip(const Observation& seen, const Eigen::Matrix3d& R_WC,
                                        const BodyModel& expected);
// How far the seen rays are from those of a body, weighted, large differences counting less.
double ray_distance(const Observation& seen, const BodyModel& body, const CameraPlacement& camera);

enum class FacingVerdict : std::uint8_t {
  kPlausible,
  kRefused,  // no body turns so
  kLasting,  // it has been seen for so long that the body was taken for turned before
};

class FlipWatch {
 public:
  void clear() { *this = FlipWatch(); }
  // Turns are from the expected facing to the seen one, `unseen_s` after the body was seen. A
  // suspect one is looked at closely; one that is far no body makes.
  static bool is_suspect(double turn_rad, double unseen_s);
  static bool is_far(double turn_rad, double unseen_s);
  // `is_explained`: sides exchanged or depth reversed explain it. `seconds` since the last picture.
  FacingVerdict judge(const std::optional<double>& seen_rad, double turn_rad, bool is_far,
                      bool is_explained, double seconds, double unseen_s);

 private:
  void believe(double turn_rad);

  std::optional<double> seen_rad_;  // in the last picture
  bool has_jumped_ = false;
  double refused_s_ = 0.0;  // falls again while nothing is refused
  // The last jump that was believed: where it is seen undone, the body never turned.
  std::optional<double> jump_rad_;
  double since_jump_s_ = 0.0;
};

class FacingLimit {
 public:
  static constexpr double kFastest_rad_s = 12.2;  // 700 degrees

  void clear() { *this = FacingLimit(); }
  // Turns `pose` about the vertical through its hips so that it faces no further from the last
  // one than a body turns in `seconds`.
  void apply(const Skeleton& skeleton, double seconds, Pose& pose);
  // While what is shown faces elsewhere than what is seen, feet cannot be where they are seen.
  bool is_behind() const;

 private:
  std::optional<double> shown_rad_;
  double offset_rad_ = 0.0;  // of what is shown, from what is given
  double since_s_ = 0.0;
};

}  // namespace dance
