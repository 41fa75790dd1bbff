// FingerSolver: turns a hand's 21 points into rotations of its finger bones: each finger bends in
// one plane of its own, spreads at its first joint only, and neither bends backwards nor further
// than fingers do. Lengths of bones say nothing and are not used. A hand that is no longer seen
// keeps its fingers for a moment and then relaxes.
//
// Units/frames: Hands as in core/pose/pose.h; points as in producers/camera/hands/hand_landmarks.h.
//               A PalmFrame turns the hand bone of a T-pose into the camera's axes.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      palm_of() is nullopt where the points make no palm. Rotations are always valid.
// Source:       ranges of joints: AAOS, Joint Motion (1965), and Hume et al. 1990, rounded up;
//               Casiez, Roussel, Vogel: 1€ filter, CHI 2012.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/pose/pose.h"
#include "producers/camera/estimator/one_euro.h"
#include "producers/camera/hands/hand_landmarks.h"

namespace dance {

// R_C,hand of the side's hand bone.
std::optional<Eigen::Quaternionf> palm_of(const HandLandmarks& hand, HandSide side);

// What the joints of a hand are bent and spread by, in radians; both sides alike.
struct FingerAngles {
  // Thumb to little finger: bending of its joints, from the hand outwards. Of the thumb's first
  // joint the other two say what is turned.
  std::array<std::array<float, 3>, 5> bend{};
  std::array<float, 5> spread{};  // towards the thumb; of the thumb, out of the palm's plane
};
// Limited to what fingers can do.
FingerAngles finger_angles(const HandLandmarks& hand, const Eigen::Quaternionf& R_CHand,
                           HandSide side);
// Writes the 15 bones of the side.
void write_fingers(const FingerAngles& angles, HandSide side, Hands& out);

// Left and right exchanged, as a mirror does.
void mirror(Hands& hands);

class FingerSolver {
 public:
  // `smooth` as SolverOptions has it.
  explicit FingerSolver(double smooth = 1.0) : smooth_(smooth) {}

  // The side was looked for at `now`; `hand` as the tracker has it.
  void see(const HandLandmarks& hand, HandSide side, MonoTime now);
  // False where no hand has been seen for so long that both are relaxed. Presence has the bones of
  // hands that are seen.
  bool write(MonoTime now, Hands& out) const;
  void reset() { sides_ = {}; }

 private:
  struct Side {
    std::optional<MonoTime> seen;  // last
    bool is_seen = false;          // when it was looked for last
    FingerAngles angles;
    std::array<OneEuro, 20> filters;
  };
  float share_left(const Side& side, MonoTime now) const;

  double smooth_;
  std::array<Side, 2> sides_;
};

}  // namespace dance
