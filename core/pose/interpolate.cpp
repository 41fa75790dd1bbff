#include "core/pose/interpolate.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Cosine of half the angle: beyond it chord and arc differ too much.
constexpr float kLeastDot = 0.92f;
// A slope of at most three times either step does not overshoot.
constexpr float kMostSlope = 3.0f;
// Where a position reverses it may overshoot as a body does: by less than a third of the smaller
// step.
constexpr float kMostTurningSlope = 2.0f;

// A neighbour nearer than this part of the step says little about the speed.
constexpr float kLeastGap = 0.3f;

// All but rotations and positions.
Pose between_stamps(const Pose& a, const Pose& b, float fraction) {
  Pose out = fraction < 0.5f ? a : b;  // what is not interpolated: sequence, presence, stamps
  out.confidence = std::clamp(a.confidence + fraction * (b.confidence - a.confidence), 0.0f, 1.0f);
  const Duration step = b.capture_time - a.capture_time;
  const MonoTime stamped = out.capture_time;
  out.capture_time =
      a.capture_time + Duration::seconds(step.as_seconds() * static_cast<double>(fraction));
  // Stamps are those of the nearer pose, moved with the capture time, so that each step keeps its
  // age.
  for (MonoTime& hop : out.hops)
    if (hop.is_set()) hop += out.capture_time - stamped;
  out.music_beats = a.music_beats + static_cast<double>(fraction) * (b.music_beats - a.music_beats);
  return out;
}

// The cubic from a to b, whose time apart is 1; the poses around them are `before` and `after` of
// it away, 0: not known.
struct Cubic {
  Cubic(float before, float after, float t)
      : before_time(before),
        after_time(after),
        h00((1.0f + 2.0f * t) * (1.0f - t) * (1.0f - t)),
        h10(t * (1.0f - t) * (1.0f - t)),
        h01(t * t * (3.0f - 2.0f * t)),
        h11(t * t * (t - 1.0f)) {}

  template <class Vector>
  Vector at(const Vector& before, const Vector& a, const Vector& b, const Vector& after) const {
    const Vector step = b - a;
    const float step2 = step.squaredNorm();
    const Vector from = before_time > 0.0f ? Vector((a - before) / before_time) : step;
    const Vector to = after_time > 0.0f ? Vector((after - b) / after_time) : step;
    return h00 * a + h10 * slope(from, before_time, step, step2) + h01 * b +
           h11 * slope(to, after_time, step, step2);
  }

  // At a or b, of the parabola through it and its neighbours; with one neighbour, straight.
  template <class Vector>
  static Vector slope(const Vector& outer, float outer_time, const Vector& step, float step2) {
    return limited(Vector((outer + outer_time * step) / (1.0f + outer_time)), outer, step, step2);
  }

  // A place, along each axis.
  static Eigen::Vector3f limited(Eigen::Vector3f slope, const Eigen::Vector3f& outer,
                                 const Eigen::Vector3f& step, float /*step2*/) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const float most = outer[i] * step[i] > 0.0f ? kMostSlope : kMostTurningSlope;
      const float least_step = std::min(std::abs(outer[i]), std::abs(step[i]));
      slope[i] = std::clamp(slope[i], -most * least_step, most * least_step);
    }
    return slope;
  }

  // A rotation, which has no axes of its own.
  static Eigen::Vector4f limited(const Eigen::Vector4f& slope, const Eigen::Vector4f& outer,
                                 const Eigen::Vector4f& /*step*/, float step2) {
    const float most2 = kMostSlope * kMostSlope * std::min(step2, outer.squaredNorm());
    const float is2 = slope.squaredNorm();
    return is2 > most2 ? Eigen::Vector4f(slope * std::sqrt(most2 / is2)) : slope;
  }

  float before_time, after_time, h00, h10, h01, h11;
};

Eigen::Vector4f on_side_of(const Eigen::Vector4f& q, const Eigen::Vector4f& side) {
  return q.dot(side) < 0.0f ? Eigen::Vector4f(-q) : q;
}

float ratio(const Pose* from, const Pose* to, Duration step) {
  if (!from || !to) return 0.0f;
  const auto gap =
      static_cast<float>((to->capture_time - from->capture_time).as_seconds() / step.as_seconds());
  return gap < kLeastGap ? 0.0f : gap;
}

}  // namespace

Pose interpolate(const Pose& a, const Pose& b, float fraction) {
  Pose out = between_stamps(a, b, fraction);
  for (std::size_t i = 0; i < kBoneCount; ++i)
    out.R_PB[i] = a.R_PB[i].slerp(fraction, b.R_PB[i]).normalized();
  out.p_WH_m = a.p_WH_m + fraction * (b.p_WH_m - a.p_WH_m);
  return out;
}

Hands interpolate(const Hands& a, const Hands& b, float fraction) {
  Hands out = fraction < 0.5f ? a : b;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    out.R_PB[i] = a.R_PB[i].slerp(fraction, b.R_PB[i]).normalized();
  return out;
}

Pose interpolate_smoothly(const Pose* before, const Pose& a, const Pose& b, const Pose* after,
                          float fraction) {
  if (!before && !after) return interpolate(a, b, fraction);
  Pose out = between_stamps(a, b, fraction);
  const Duration step = b.capture_time - a.capture_time;
  const Cubic cubic(ratio(before, &a, step), ratio(&b, after, step), fraction);
  const Pose &first = before ? *before : a, &last = after ? *after : b;
  out.p_WH_m = cubic.at<Eigen::Vector3f>(first.p_WH_m, a.p_WH_m, b.p_WH_m, last.p_WH_m);
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const Eigen::Vector4f &from = a.R_PB[i].coeffs(), to = on_side_of(b.R_PB[i].coeffs(), from);
    if (from.dot(to) < kLeastDot) {
      out.R_PB[i] = a.R_PB[i].slerp(fraction, b.R_PB[i]).normalized();
      continue;
    }
    out.R_PB[i].coeffs() = cubic
                               .at<Eigen::Vector4f>(on_side_of(first.R_PB[i].coeffs(), from), from,
                                                    to, on_side_of(last.R_PB[i].coeffs(), to))
                               .normalized();
  }
  return out;
}

float largest_angle_rad(const Pose& a, const Pose& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    largest = std::max(largest, a.R_PB[i].angularDistance(b.R_PB[i]));
  return largest;
}

}  // namespace dance
