// PredictionCheck: how wrong predictions of one dancer were: keeps what the stage showed of moments
// that had not arrived, and compares it with what was captured of them once that has come.
//
// Units/frames: moments are capture times of one clock; errors in mm. A joint's error is the
//               distance of its two places seen from the hips, so that the hips' place and turn do
//               not count; theirs is the distance in W.
// Ownership:    room for kPending poses; never allocates.
// Threads:      none inside; one owner.
// Failure:      a moment between two poses that are more than kLongestGap apart is left out: what
//               was danced there is not known.
#pragma once

#include <array>
#include <cstdint>

#include "core/pose/kinematics.h"
#include "viewer/instruments/sample_window.h"

namespace dance {

class PredictionCheck {
 public:
  static constexpr std::size_t kPending = 64;
  static constexpr Duration kLongestGap = Duration::ms(200);

  void set_body(const Skeleton& skeleton) { skeleton_ = skeleton; }
  // The stage shows this pose; it is a prediction where its moment has not arrived.
  void on_staged(const Pose& staged);
  // The newest pose of the dancer.
  void on_arrived(const Pose& pose);
  void restart();

  struct Errors {
    float mean_mm, p95_mm, hips_mm;  // not a number without any
  };
  // Of what has been compared since the last call.
  Errors take();

 private:
  void compare(const Pose& shown, const Pose& danced);

  Skeleton skeleton_ = average_skeleton();
  std::array<Pose, kPending> pending_;
  std::size_t first_ = 0, count_ = 0;
  Pose newest_;
  bool has_newest_ = false;
  SampleWindow<2048> joints_mm_;
  SampleWindow<256> hips_mm_;
};

}  // namespace dance
