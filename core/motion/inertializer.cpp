#include "core/motion/inertializer.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// A spring released at rest is fastest, with offset · y / e, after 1/y. Large offsets decay slower,
// so that corrections move no joint faster than dancers do, summed over the bones of a limb and the
// hips' place.
constexpr float kE = 2.7182818f;
constexpr float kFastestJoint_m_s = 4.5f;
constexpr float kFastestHips_m_s = 2.0f;
constexpr float kFastestTurn_rad_s = 9.0f;
// A correction's initial speed, where the caller gives it.
constexpr float kMostSpeed_m_s = 6.0f;
constexpr float kMostTurn_rad_s = 20.0f;

float decay_for(float y, float size, float fastest) {
  return size * y > kE * fastest ? kE * fastest / size : y;
}

// False for NaN.
bool is_same(const Pose& a, const Pose& b) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (a.R_PB[i].coeffs() != b.R_PB[i].coeffs()) return false;
  return a.p_WH_m == b.p_WH_m;
}

// From each bone to the end of its limb, metres, of an adult.
constexpr std::array<float, kBoneCount> kLever_m{0.9f, 0.8f, 0.7f, 0.65f, 0.3f, 0.25f, 0.8f, 0.7f,
                                                 0.4f, 0.2f, 0.8f, 0.7f,  0.4f, 0.2f,  0.9f, 0.5f,
                                                 0.2f, 0.1f, 0.9f, 0.5f,  0.2f, 0.1f};
constexpr std::array<Bone, 5> kEnds{Bone::kHead, Bone::kLeftHand, Bone::kRightHand, Bone::kLeftToes,
                                    Bone::kRightToes};

}  // namespace

Inertializer::Inertializer(Duration half_life) { set_half_life(half_life); }

void Inertializer::set_half_life(Duration half_life) {
  half_life_ = std::clamp(half_life, Duration::ms(1), Duration::s(2));
  y_ = Spring::y_of_half_life(half_life_);
  set_decay();
}

void Inertializer::clear() {
  rotations_.fill(Spring());
  hips_ = Spring();
  at_rest_ = true;
}

void Inertializer::advance_to(MonoTime now) {
  const Duration step = now - time_;
  time_ = now;
  if (at_rest_ || step <= Duration()) return;
  // After so long every offset is 0, and the numbers stay finite.
  if (step > Duration::s(10)) return clear();
  const auto seconds = static_cast<float>(step.as_seconds());
  hips_.advance(decay_, seconds);
  at_rest_ = hips_.is_at_rest();
  for (Spring& rotation : rotations_) {
    rotation.advance(decay_, seconds);
    at_rest_ = at_rest_ && rotation.is_at_rest();
  }
  if (at_rest_) clear();
}

void Inertializer::set_decay() {
  // One y for the whole body.
  float y = decay_for(y_, hips_.offset.norm(), kFastestHips_m_s);
  std::array<float, kBoneCount> moved_m;  // at most, of the bone's end
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const float turn = rotations_[b].offset.norm();
    y = std::min(y, decay_for(y_, turn, kFastestTurn_rad_s));
    moved_m[b] = kLever_m[b] * turn +
                 (b ? moved_m[static_cast<std::size_t>(kBones[b].parent)] : hips_.offset.norm());
  }
  for (const Bone end : kEnds)
    y = std::min(y, decay_for(y_, moved_m[index_of(end)], kFastestJoint_m_s));
  decay_ = y;
}

void Inertializer::add(MonoTime now, const Pose& was, const Pose& is) {
  advance_to(now);
  if (is_same(was, is)) {
    // Smaller offsets decay faster from here on.
    if (!at_rest_) set_decay();
    return;
  }
  const Vector3f hips = hips_.offset + (was.p_WH_m - is.p_WH_m);
  // Also true for NaN.
  if (!(hips.squaredNorm() <= kFurthest_m * kFurthest_m)) {
    ++jumps_;
    return clear();
  }
  hips_.offset = hips;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    // shown = exp(offset) · was = exp(new offset) · is
    Vector3f& offset = rotations_[b].offset;
    offset = rotation_vector(exp_rotation(offset) * was.R_PB[b] * is.R_PB[b].conjugate());
    if (!offset.allFinite()) rotations_[b] = Spring();
  }
  at_rest_ = hips_.is_at_rest() &&
             std::all_of(rotations_.begin(), rotations_.end(),
                         [](const Spring& rotation) { return rotation.is_at_rest(); });
  if (at_rest_) return clear();
  set_decay();
}

void Inertializer::add_speed(Spring& spring, const Vector3f& velocity, float most) const {
  spring.velocity += velocity;
  const float speed = spring.velocity.norm();
  if (speed > most) spring.velocity *= most / speed;
}

void Inertializer::add(MonoTime now, const Pose& was_before, const Pose& was, const Pose& is_before,
                       const Pose& is, Duration step) {
  const std::uint64_t jumps = jumps_;
  add(now, was, is);
  if (jumps_ != jumps || step <= Duration()) return;
  const auto per_s = static_cast<float>(1.0 / step.as_seconds());
  add_speed(hips_, per_s * ((was.p_WH_m - was_before.p_WH_m) - (is.p_WH_m - is_before.p_WH_m)),
            kMostSpeed_m_s);
  at_rest_ = false;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Vector3f was_turn = rotation_vector(was.R_PB[b] * was_before.R_PB[b].conjugate());
    const Vector3f is_turn = rotation_vector(is.R_PB[b] * is_before.R_PB[b].conjugate());
    add_speed(rotations_[b], per_s * (was_turn - is_turn), kMostTurn_rad_s);
  }
}

void Inertializer::apply(MonoTime now, Pose& pose) {
  advance_to(now);
  if (at_rest_) return;
  pose.p_WH_m += hips_.offset;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    pose.R_PB[b] = exp_rotation(rotations_[b].offset) * pose.R_PB[b];
}

}  // namespace dance
