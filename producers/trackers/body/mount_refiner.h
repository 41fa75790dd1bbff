// MountRefiner: what a T-pose gets wrong of worn trackers, found while they dance: the mean
// difference, on the bone, between where a guide would have it and where it is measured. A pose
// that was held badly for a second is off by centimetres; a dance is not, in the mean. While a
// dancer stands about nothing is learnt: that is one pose, too, and the guide may be wrong about
// it.
//
// Units/frames: on each bone, metres and rotation vectors.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. Differences beyond what a T-pose can be off by are cut.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "producers/trackers/body/body_guide.h"

namespace dance {

class MountRefiner {
 public:
  void reset() { *this = MountRefiner(); }

  // The guess must have been made from these very bones.
  void observe(const BonePlaces& bones, const BodyGuess& guess, float seconds) {
    const Eigen::Vector3f head = bones.of(TrackedPoint::kHead).p_W_m;
    const float speed_m_s = seconds > 0.0f ? (head - head_m_).norm() / seconds : 0.0f;
    head_m_ = head;
    if (speed_m_s > kFastest_m_s) return;
    speed_m_s_ += (1.0f - std::exp(-seconds / kSpeed_s)) * (speed_m_s - speed_m_s_);
    if (speed_m_s_ < kDances_m_s) return;
    for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
      if ((bones.presence >> i & 1u) == 0 || !is_refined(i)) continue;
      Found& found = found_[i];
      found.seen_s = std::min(found.seen_s + seconds, kMostSeen_s);
      const float share = seconds / (found.seen_s + kDoubt_s);
      const Place& is = bones.places[i];
      const Eigen::Quaternionf turn = is.R_W.conjugate() * guess.R(kPointBones[i]);
      found.turn_rad += share * (rotation_vector(turn) - found.turn_rad);
      found.turn_rad = cut(found.turn_rad, kMostTurn_rad);
      const Eigen::Vector3f* place = place_of(guess, i);
      if (!place) continue;
      found.shift_m += share * (is.R_W.conjugate() * (*place - is.p_W_m) - found.shift_m);
      found.shift_m = cut(found.shift_m, kMostShift_m);
    }
  }

  void apply(BonePlaces& bones) const {
    for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
      if ((bones.presence >> i & 1u) == 0 || !is_refined(i)) continue;
      Place& place = bones.places[i];
      place.p_W_m += place.R_W * found_[i].shift_m;
      place.R_W = (place.R_W * exp_rotation(found_[i].turn_rad)).normalized();
    }
  }

 private:
  struct Found {
    Eigen::Vector3f shift_m = Eigen::Vector3f::Zero(), turn_rad = Eigen::Vector3f::Zero();
    float seen_s = 0.0f;
  };

  static constexpr float kDances_m_s = 0.2f, kFastest_m_s = 10.0f, kSpeed_s = 1.0f;
  static constexpr float kDoubt_s = 4.0f, kMostSeen_s = 60.0f;
  static constexpr float kMostShift_m = 0.1f, kMostTurn_rad = 0.35f;

  // Head and hands are kept where they are measured.
  static bool is_refined(std::size_t point) { return point > index_of(TrackedPoint::kRightHand); }
  static Eigen::Vector3f cut(const Eigen::Vector3f& v, float most) {
    const float size = v.norm();
    return size > most ? Eigen::Vector3f(v * (most / size)) : v;
  }
  // Of those whose place a guess says.
  static const Eigen::Vector3f* place_of(const BodyGuess& guess, std::size_t point) {
    if (point == index_of(TrackedPoint::kHips)) return &guess.p_WH_m;
    if (point == index_of(TrackedPoint::kLeftFoot)) return &guess.ankles_W_m[0];
    if (point == index_of(TrackedPoint::kRightFoot)) return &guess.ankles_W_m[1];
    return nullptr;
  }

  std::array<Found, kTrackedPointCount> found_;
  Eigen::Vector3f head_m_ = Eigen::Vector3f::Zero();
  float speed_m_s_ = 0.0f;  // of the head
};

}  // namespace dance
