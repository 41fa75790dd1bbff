// XrSensors: all that a headset tells of its dancer at one moment: the tracked points, a body where
// the headset sees one, and fingers. Placed in this house.
//
// Units/frames: XrPlacement is X_WS, the session's base space in W: a turn about the vertical and a
//               shift.
// Ownership:    owns trackers of hands and body; refers to input and session, which must outlive
//               it.
// Threads:      none inside; one owner. Several may look at the same session.
// Failure:      a part that the runtime refuses is left out, and note() says so.
#pragma once

#include <memory>
#include <string>

#include "producers/receive/joint_figure.h"
#include "producers/trackers/tracker_frame.h"
#include "producers/xr/xr_body.h"
#include "producers/xr/xr_hands.h"

namespace dance {

struct XrPlacement {
  float turn_rad = 0.0f;
  Eigen::Vector3f shift_m = Eigen::Vector3f::Zero();

  Eigen::Quaternionf turn() const;
  XrPlace in_house(const XrPlace& in_base) const;
  Eigen::Vector3f in_house(const Eigen::Vector3f& p_m) const { return turn() * p_m + shift_m; }
};

// A spot on the floor, and where one looks there: 0 along +Z.
struct XrSpot {
  float x_m = 0.0f, z_m = 0.0f, heading_rad = 0.0f;
};
// X_WS of the new base space, which is there in the old one; what of it is a tilt is left out.
XrPlacement moved(const XrPlacement& placement, const XrPlace& new_in_old);

// Below the head, where it looks; nullopt where it looks straight up or down.
std::optional<XrSpot> spot_of(const XrPlace& head);
// Puts the head over the spot, looking along its heading; `floor_m` is the floor in the base space.
XrPlacement placement_of(const XrPlace& head_in_base, const XrSpot& spot, float floor_m);

struct XrSight {
  TrackerFrame points;
  FigureFrame figure;
  bool has_figure = false;               // a whole one, legs too
  MonoTime figure_moment;                // when it was so; the points are of the moment asked for
  Hands hands;                           // none: no presence
  std::array<bool, kXrHands> is_bare{};  // the hand is seen, no controller is held
  std::array<bool, kXrHands> is_pinching{};
  std::array<XrPlace, kXrHands> bare_aims_W{};             // where bare hands point
  std::array<Eigen::Vector3f, kXrHands> fingertips_W_m{};  // of bare hands: the forefingers'
};

class XrSensors {
 public:
  XrSensors(const XrDancerSession& session, const XrInput& input);

  // `moment` is `time` in this house's clock.
  void look(XrTime time, MonoTime moment, const XrPlacement& placement, XrSight& sight);
  bool sees_body() const { return body_ != nullptr; }
  // What is left out and why; "" where nothing is.
  const std::string& note() const { return note_; }

 private:
  void look_at_hands(XrTime time, const XrPlacement& placement, XrSight& sight);
  void look_at_body(XrTime time, const XrPlacement& placement, XrSight& sight);
  MonoTime moment_of(XrTime seen, MonoTime asked) const;

  const XrDancerSession& session_;
  const XrInput& input_;
  std::unique_ptr<XrHands> hands_;
  std::unique_ptr<XrBody> body_;
  std::string note_;
};

}  // namespace dance
