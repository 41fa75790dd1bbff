#include "core/codec/lattice/body_lattice.h"

#include <algorithm>

namespace dance {
namespace {

using exact::Quat;
using exact::Vec;

// Largest step of a rotation: below what is visible.
constexpr double kLargestAngleStep_rad = 0.0667;

Vec to_vec(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

// The rotation of a frame's axes; columns must be orthonormal.
Quat from_axes(const Vec& x, const Vec& y, const Vec& z) {
  const double trace = x.x + y.y + z.z;
  Quat q;
  if (trace > 0.0) {
    q = {1.0 + trace, y.z - z.y, z.x - x.z, x.y - y.x};
  } else if (x.x >= y.y && x.x >= z.z) {
    q = {y.z - z.y, 1.0 + x.x - y.y - z.z, y.x + x.y, z.x + x.z};
  } else if (y.y >= z.z) {
    q = {z.x - x.z, y.x + x.y, 1.0 + y.y - x.x - z.z, z.y + y.z};
  } else {
    q = {x.y - y.x, z.x + x.z, z.y + y.z, 1.0 + z.z - x.x - y.y};
  }
  return exact::normalized(q);
}

// Axes with z along the bone and x as near the hinge as possible.
Quat axes_along(const Vec& bone, const std::array<float, 3>& hinge) {
  const double long_m = exact::length(bone);
  const Vec z = long_m > 1e-6 ? (1.0 / long_m) * bone : Vec{0.0, 1.0, 0.0};
  Vec x{hinge[0], hinge[1], hinge[2]};
  x = x - exact::dot(x, z) * z;
  if (exact::length(x) < 1e-3) {
    x = std::abs(z.x) < 0.7 ? Vec{1.0, 0.0, 0.0} : Vec{0.0, 0.0, 1.0};
    x = x - exact::dot(x, z) * z;
  }
  x = (1.0 / exact::length(x)) * x;
  return from_axes(x, exact::cross(z, x), z);
}

}  // namespace

BodyLattice::BodyLattice(const Skeleton& skeleton, const RestModel& rest) {
  for (std::size_t b = 0; b < kBoneCount; ++b) offset_[b] = to_vec(skeleton.offset_m[b]);
  for (std::size_t t = 0; t < kTipCount; ++t) tip_[t] = to_vec(skeleton.tip_m[t]);
  find_ends();
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const auto& model = rest.bones[b];
    Quat centre{model.centre_xyzw[3], model.centre_xyzw[0], model.centre_xyzw[1],
                model.centre_xyzw[2]};
    centre = b == 0 ? Quat{} : exact::normalized(centre);
    const Vec along = b == 0 ? Vec{0.0, 1.0, 0.0} : end_[b];
    const Quat axes = axes_along(along, model.hinge);
    frames_[b] = {centre * axes, exact::conj(axes)};
  }
  find_steps();
}

// A bone of no length ends where the next one does.
void BodyLattice::find_ends() {
  for (std::size_t i = kBoneCount; i-- > 0;) {
    if (kNextBone[i] < 0) {
      end_[i] = tip_[tip_of(i)];
      continue;
    }
    const auto next = static_cast<std::size_t>(kNextBone[i]);
    end_[i] = offset_[next];
    begins_at_end_[next] = exact::length(end_[i]) >= kShellRadius_m;
    if (!begins_at_end_[next]) end_[i] = end_[i] + end_[next];
  }
}

// A bone's lever is the distance to the points rigidly attached to it: its end; shoulders and neck
// for the bones of the trunk, as shoulders often do not move; the whole foot.
void BodyLattice::find_steps() {
  std::array<std::array<Vec, 6>, kBoneCount> reach{};
  std::array<std::size_t, kBoneCount> count{};
  const auto add = [&](std::size_t bone, const Vec& v) { reach[bone][count[bone]++] = v; };
  for (std::size_t b = 0; b < kBoneCount; ++b) add(b, end_[b]);
  const auto at = [](Bone bone) { return index_of(bone); };
  for (const Bone arm : {Bone::kLeftUpperArm, Bone::kRightUpperArm, Bone::kNeck}) {
    Vec v = offset_[at(arm)];
    std::size_t bone = static_cast<std::size_t>(kBones[at(arm)].parent);
    if (arm != Bone::kNeck) {
      v = v + offset_[bone];
      bone = at(Bone::kUpperChest);
    }
    add(bone, v);
    v = v + offset_[at(Bone::kUpperChest)];
    add(at(Bone::kChest), v);
    v = v + offset_[at(Bone::kChest)];
    add(at(Bone::kSpine), v);
  }
  for (const Bone leg : {Bone::kLeftUpperLeg, Bone::kRightUpperLeg}) add(0, offset_[at(leg)]);
  for (const auto& [foot, toes] :
       {std::pair{Bone::kLeftFoot, Bone::kLeftToes}, std::pair{Bone::kRightFoot, Bone::kRightToes}})
    add(at(foot), offset_[at(toes)] + tip_[tip_of(at(toes))]);

  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Vec along = b == 0 ? Vec{0.0, 1.0, 0.0} : end_[b];
    const double long_m = exact::length(along);
    double swing_m = kShellRadius_m, twist_m = kShellRadius_m;
    for (std::size_t i = 0; i < count[b]; ++i) {
      const Vec& r = reach[b][i];
      swing_m = std::max(swing_m, exact::length(r));
      if (long_m > 1e-6)
        twist_m = std::max(twist_m, exact::length(exact::cross(r, along)) / long_m);
    }
    for (std::size_t level = 0; level < kLevelCount; ++level) {
      const double error_m = kLevelErrors_m[level];
      const std::size_t c = first_coordinate(b);
      const double swing = std::min(error_m / swing_m, kLargestAngleStep_rad);
      const double twist = std::min(error_m / twist_m, kLargestAngleStep_rad);
      const double turn = std::ceil(2.0 * exact::kPi / twist);
      auto& step = steps_[level].step;
      step[c] = step[c + 1] = swing;
      step[c + 2] = 2.0 * exact::kPi / turn;
      steps_[level].turn[c + 2] = static_cast<std::int32_t>(turn);
    }
  }
  for (std::size_t level = 0; level < kLevelCount; ++level) {
    LatticeSteps& of = steps_[level];
    for (std::size_t c = 0; c < 3; ++c) of.step[c] = kLevelErrors_m[level];
    for (std::size_t c = 0; c < kCoordinateCount; ++c) {
      of.per_step[c] = 1.0 / of.step[c];
      of.per_step_float[c] = static_cast<float>(of.per_step[c]);
    }
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const std::size_t parent = first_coordinate(static_cast<std::size_t>(kBones[b].parent));
      for (std::size_t i = 0; i < 3; ++i)
        of.of_parent[b][i] =
            static_cast<float>(of.step[parent + i] * of.per_step[first_coordinate(b) + i]);
    }
  }
}

// The hips' heading is the outermost turn, so that their tilt is seen from the dancer: the swing
// and twist of the inverse.
exact::SwingTwist BodyLattice::angles_of(std::size_t bone, const Quat& R_PB) const {
  const Frame& f = frames_[bone];
  const Quat q = bone == 0 ? exact::conj(R_PB) : R_PB;
  return exact::to_swing_twist(exact::conj(f.before) * q * exact::conj(f.after));
}

Quat BodyLattice::rotation_of(std::size_t bone, const exact::SwingTwist& angles) const {
  return local(bone, exact::to_quat(angles));
}

}  // namespace dance
