// XrHands: bare hands as the headset's cameras see them: the rotations of their finger bones, and
// where a controller would be held, for the solver.
//
// Units/frames: places in the session's base space; Hands as in core/pose/pose.h.
// Ownership:    owns the runtime's trackers; refers to the session, which must outlive it.
// Threads:      none inside; one owner.
// Failure:      create() names what the runtime refuses; a hand that is not seen is not told.
// Source:       XR_EXT_hand_tracking: of each joint -Z points to the tip and +Y out of the back.
#pragma once

#include <array>
#include <optional>

#include "core/pose/pose.h"
#include "producers/xr/xr_input.h"

namespace dance {

// Of one hand at one moment.
struct XrHandJoints {
  std::array<XrPlace, XR_HAND_JOINT_COUNT_EXT> joints;

  const XrPlace& at(XrHandJointEXT joint) const { return joints[static_cast<std::size_t>(joint)]; }
};

// Where OpenXR's grip pose is of a controller in that hand.
XrPlace grip_of(const XrHandJoints& joints, XrHand hand);
// Where a bare hand points: along its fingers, from the knuckle of the forefinger.
XrPlace aim_of(const XrHandJoints& joints);
// The 15 finger bones of that side, present.
void write_fingers(const XrHandJoints& joints, XrHand hand, Hands& out);
// Thumb and forefinger touch, which stands for a press.
bool is_pinching(const XrHandJoints& joints);

class XrHands {
 public:
  static Result<std::unique_ptr<XrHands>> create(const XrDancerSession& session);
  ~XrHands();
  XrHands(const XrHands&) = delete;
  XrHands& operator=(const XrHands&) = delete;

  std::optional<XrHandJoints> see(XrHand hand, XrTime time);

 private:
  explicit XrHands(const XrDancerSession& session) : session_(session) {}
  Result<void> open();

  const XrDancerSession& session_;
  PFN_xrDestroyHandTrackerEXT destroy_ = nullptr;
  PFN_xrLocateHandJointsEXT locate_ = nullptr;
  std::array<XrHandTrackerEXT, kXrHands> trackers_{};
};

}  // namespace dance
