// The lattice that a body is quantised on: each bone's rotation as swing and twist about its rest,
// in steps so small that no joint moves further than the error asked for; the hips as a place, a
// heading and a tilt. The dancer's proportions give the steps, a trained model the rests.
//
// Units/frames: coordinates are radians, and metres for the hips' place; coordinate i is whole
//               steps of step(i, level). Bones as in core/pose/bone.h, hips first.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      none: a body of size 0 has steps, too.
#pragma once

#include <array>
#include <cstdint>

#include "core/codec/exact/swing_twist.h"
#include "core/pose/skeleton.h"

namespace dance {

// Place x y z of the hips, then swing u, swing v, twist w of each bone.
constexpr std::size_t kCoordinateCount = 3 + 3 * kBoneCount;
constexpr std::size_t first_coordinate(std::size_t bone) { return 3 + 3 * bone; }
// Padded to a multiple of four, for SIMD.
constexpr std::size_t kPaddedCount = (kCoordinateCount + 3) / 4 * 4;

// Largest errors that lattices are made for.
constexpr std::array<double, 8> kLevelErrors_m{0.000125, 0.00025, 0.0005, 0.001,
                                               0.002,    0.005,   0.010,  0.020};
constexpr std::size_t kLevelCount = kLevelErrors_m.size();

// Distance of skin from a joint.
constexpr double kShellRadius_m = 0.03;

// Trained rests of bones.
struct RestModel {
  struct BoneRest {
    std::array<float, 4> centre_xyzw{0.0f, 0.0f, 0.0f, 1.0f};  // mean rotation in the parent
    std::array<float, 3> hinge{1.0f, 0.0f, 0.0f};  // axis of the bone that it turns most about
  };
  std::array<BoneRest, kBoneCount> bones;
};

// The part of a decoded body that later frames refer to.
struct ReferenceBody {
  alignas(16) std::array<double, kPaddedCount> x{};  // coordinates
  std::array<exact::Four, kBoneCount> spun{};        // seat, swing and twist; w first
  std::array<exact::Vec, kBoneCount> end{};          // of each bone: next joint, or tip
};
// A decoded body, computed exactly alike at both ends.
struct LatticeBodyState : ReferenceBody {
  std::array<exact::Quat, kBoneCount> global{};
  std::array<exact::Quat, kBoneCount> seat{};  // of each bone's swing and twist, in W
  std::array<exact::Vec, kBoneCount> joint{};
};

// A lattice of one level.
struct LatticeSteps {
  alignas(16) std::array<double, kPaddedCount> step{};
  alignas(16) std::array<double, kPaddedCount> per_step{};  // 1 / step
  // Steps in a whole turn; 0 where the coordinate does not wrap.
  std::array<std::int32_t, kPaddedCount> turn{};
  alignas(16) std::array<float, kPaddedCount> per_step_float{};
  // How many steps of each bone's u, v and w one of its parent's is.
  std::array<exact::Four, kBoneCount> of_parent{};
};

class BodyLattice {
 public:
  BodyLattice() : BodyLattice(average_skeleton(), RestModel()) {}
  BodyLattice(const Skeleton& skeleton, const RestModel& rest);

  const LatticeSteps& steps(std::size_t level) const { return steps_[level]; }
  double step(std::size_t coordinate, std::size_t level) const {
    return steps_[level].step[coordinate];
  }
  double per_step(std::size_t coordinate, std::size_t level) const {
    return steps_[level].per_step[coordinate];
  }
  std::int32_t turn(std::size_t coordinate, std::size_t level) const {
    return steps_[level].turn[coordinate];
  }

  // Coordinates of a rotation, and back. For the hips of the rotation in W.
  exact::SwingTwist angles_of(std::size_t bone, const exact::Quat& R_PB) const;
  exact::Quat rotation_of(std::size_t bone, const exact::SwingTwist& angles) const;
  exact::Quat rotation_of(std::size_t bone, const ReferenceBody& body) const {
    const double* x = body.x.data() + first_coordinate(bone);
    return rotation_of(bone, exact::SwingTwist{x[0], x[1], x[2]});
  }
  // Of a seated bone with a rotation in W: the rotation from W's axes to those of its swing and
  // twist, and the product of the two.
  exact::Quat from_room(std::size_t bone, const LatticeBodyState& state,
                        const exact::Quat& R_WB) const {
    return exact::conj(bone == 0 ? R_WB * frames_[0].before : state.seat[bone]);
  }
  exact::Quat turn_of(std::size_t bone, const exact::Quat& from_room,
                      const exact::Quat& R_WB) const {
    const exact::Quat after = exact::conj(frames_[bone].after);
    return bone == 0 ? from_room * after : from_room * R_WB * after;
  }

  // Bone after bone, parents first: joint and seat, then, with its coordinates known, the rest;
  // returns its swing and twist.
  void seat_bone(std::size_t bone, LatticeBodyState& state) const;
  exact::Quat place_bone(std::size_t bone, LatticeBodyState& state) const;
  // A bone's rotation in its parent by swing and twist.
  [[gnu::always_inline]] exact::Quat local(std::size_t bone, const exact::Quat& turn) const {
    const exact::Quat q = frames_[bone].before * turn * frames_[bone].after;
    return bone == 0 ? exact::conj(q) : q;
  }
  const exact::Vec& offset(std::size_t bone) const { return offset_[bone]; }
  // From a bone's joint to its end, in the bone's frame.
  const exact::Vec& end(std::size_t bone) const { return end_[bone]; }
  const exact::Vec& tip(std::size_t tip) const { return tip_[tip]; }

 private:
  // R_PB = before · Q · after
  struct Frame {
    exact::Quat before, after;
  };
  void find_ends();
  void find_steps();

  std::array<exact::Vec, kBoneCount> offset_;
  std::array<exact::Vec, kBoneCount> end_;
  std::array<exact::Vec, kTipCount> tip_;
  std::array<Frame, kBoneCount> frames_;
  std::array<bool, kBoneCount> begins_at_end_{};  // of its parent
  std::array<LatticeSteps, kLevelCount> steps_{};
};

// The next bone in line; −1 for an end of the body, whose tip is tip_of().
constexpr std::array<std::int8_t, kBoneCount> kNextBone{1,  2,  3,  4,  5,  -1, 7,  8,  9,  -1, 11,
                                                        12, 13, -1, 15, 16, 17, -1, 19, 20, 21, -1};
constexpr std::size_t tip_of(std::size_t bone) {
  for (std::size_t i = 0; i < kTipCount; ++i)
    if (index_of(kTipBones[i]) == bone) return i;
  return kTipCount;
}

[[gnu::always_inline]] inline void BodyLattice::seat_bone(std::size_t bone,
                                                          LatticeBodyState& state) const {
  if (bone == 0) {
    state.joint[0] = {state.x[0], state.x[1], state.x[2]};
    state.seat[0] = frames_[0].before;
    return;
  }
  const auto parent = static_cast<std::size_t>(kBones[bone].parent);
  state.joint[bone] = begins_at_end_[bone] ? state.end[parent]
                                           : state.joint[parent] +
                                                 exact::rotate(state.global[parent], offset_[bone]);
  state.seat[bone] = state.global[parent] * frames_[bone].before;
}

[[gnu::always_inline]] inline exact::Quat BodyLattice::place_bone(std::size_t bone,
                                                                  LatticeBodyState& state) const {
  const double* x = state.x.data() + first_coordinate(bone);
  const exact::Quat q = exact::to_quat({x[0], x[1], x[2]});
  if (bone == 0) {
    state.global[0] = local(0, q);
  } else {
    const exact::Quat spun = state.seat[bone] * q;
    state.spun[bone] = exact::to_floats(spun.w, spun.x, spun.y, spun.z);
    state.global[bone] = spun * frames_[bone].after;
  }
  state.end[bone] = state.joint[bone] + exact::rotate(state.global[bone], end_[bone]);
  return q;
}

}  // namespace dance
