#include "transformers/inertializer.h"

#include <algorithm>
#include <cmath>

#include "transformers/rotation_vector.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// A spring let go at rest is fastest, with offset · y / e, after 1/y. What is far is taken back slower, so that no
// correction moves faster than dancers do.
constexpr float kE = 2.7182818f;
constexpr float kFastestHips_m_s = 2.5f;
constexpr float kFastestTurn_rad_s = 9.0f;
// A correction's own speed at its begin, where the caller tells it.
constexpr float kMostSpeed_m_s = 6.0f;
constexpr float kMostTurn_rad_s = 20.0f;

float decay_for(float y, float size, float fastest) {
  return size * y > kE * fastest ? kE * fastest / size : y;
}

}  // namespace

Inertializer::Inertializer(Duration half_life) { set_half_life(half_life); }

void Inertializer::set_half_life(Duration half_life) {
  half_life_ = std::clamp(half_life, Duration::ms(1), Duration::s(2));
  y_ = Spring::y_of_half_life(half_life_);
  set_decay();
}

void Inertializer::clear() {
  rotations_.fill(Offset());
  hips_ = Offset();
  at_rest_ = true;
}

void Inertializer::advance_to(MonoTime now) {
  const Duration step = now - time_;
  time_ = now;
  if (at_rest_ || step <= Duration()) return;
  // After so long nothing is left of anything, and the numbers stay finite.
  if (step > Duration::s(10)) return clear();
  const auto seconds = static_cast<float>(step.as_seconds());
  hips_.advance(hips_.y, seconds);
  at_rest_ = hips_.is_at_rest();
  for (Offset& rotation : rotations_) {
    rotation.advance(rotation.y, seconds);
    at_rest_ = at_rest_ && rotation.is_at_rest();
  }
  if (at_rest_) clear();
}

void Inertializer::set_decay() {
  for (Offset& rotation : rotations_)
    rotation.y = decay_for(y_, rotation.offset.norm(), kFastestTurn_rad_s);
  // Where the hips are and where they turn to is one movement.
  Offset& turn = rotations_[index_of(Bone::kHips)];
  hips_.y = std::min(turn.y, decay_for(y_, hips_.offset.norm(), kFastestHips_m_s));
  turn.y = hips_.y;
}

void Inertializer::add(MonoTime now, const Pose& was, const Pose& is) {
  advance_to(now);
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
    if (!offset.allFinite()) rotations_[b] = Offset();
  }
  at_rest_ = false;
  set_decay();
}

void Inertializer::add_speed(Offset& offset, const Vector3f& velocity, float most) const {
  offset.velocity += velocity;
  const float speed = offset.velocity.norm();
  if (speed > most) offset.velocity *= most / speed;
}

void Inertializer::add(MonoTime now, const Pose& was_before, const Pose& was, const Pose& is_before,
                       const Pose& is, Duration step) {
  const std::uint64_t jumps = jumps_;
  add(now, was, is);
  if (jumps_ != jumps || step <= Duration()) return;
  const auto per_s = static_cast<float>(1.0 / step.as_seconds());
  add_speed(hips_, per_s * ((was.p_WH_m - was_before.p_WH_m) - (is.p_WH_m - is_before.p_WH_m)),
            kMostSpeed_m_s);
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
