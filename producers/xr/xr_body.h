// XrBody: a whole body as the headset sees or infers it, by whichever extension the runtime has, as
// the joints of a figure.
//
// Units/frames: places in the session's base space; rotations as FigureFrame has them: the identity
//               in T-pose facing +Z.
// Ownership:    owns the runtime's tracker; refers to the session, which must outlive it.
// Threads:      none inside; one owner.
// Failure:      create() names what the runtime refuses; see() is false where no body is seen.
// Source:       XR_FB_body_tracking, whose skeleton is a T-pose that tells each joint's axes;
//               XR_META_body_tracking_full_body; XR_BD_body_tracking, the 24 joints of SMPL, whose
//               axes are those of the room in T-pose.
#pragma once

#include <vector>

#include "producers/receive/joint_figure.h"
#include "producers/xr/openxr_more.h"
#include "producers/xr/xr_input.h"

namespace dance {

class XrBody {
 public:
  // null: this headset sees no body.
  static Result<std::unique_ptr<XrBody>> create(const XrDancerSession& session);
  ~XrBody();
  XrBody(const XrBody&) = delete;
  XrBody& operator=(const XrBody&) = delete;

  // What the headset knows at `time`; `seen` is of when that is: bodies come from cameras, and many
  // runtimes tell their last picture's.
  bool see(XrTime time, FigureFrame& figure, XrTime& seen);
  // Without them hips, chest and elbows are points for the solver.
  bool has_legs() const { return has_legs_; }

 private:
  explicit XrBody(const XrDancerSession& session) : session_(session) {}
  Result<void> open_fb();
  Result<void> open_bd();
  bool see_fb(XrTime time, FigureFrame& figure, XrTime& seen);
  bool see_bd(XrTime time, FigureFrame& figure);
  bool learn_axes();

  const XrDancerSession& session_;
  bool has_legs_ = false;
  XrBodyTrackerFB fb_ = XR_NULL_HANDLE;
  XrBodyTrackerBD bd_ = XR_NULL_HANDLE;
  PFN_xrDestroyBodyTrackerFB destroy_fb_ = nullptr;
  PFN_xrLocateBodyJointsFB locate_fb_ = nullptr;
  PFN_xrGetBodySkeletonFB skeleton_fb_ = nullptr;
  PFN_xrDestroyBodyTrackerBD destroy_bd_ = nullptr;
  PFN_xrLocateBodyJointsBD locate_bd_ = nullptr;
  std::vector<XrBodyJointLocationFB> located_;
  std::vector<XrBodySkeletonJointFB> skeleton_;
  std::vector<Eigen::Quaternionf> R_JB_;  // of each joint: its bone of the T-pose, in its axes
  bool has_axes_ = false;
  std::uint32_t skeleton_change_ = 0;
};

}  // namespace dance
