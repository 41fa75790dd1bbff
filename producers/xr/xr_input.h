// XrInput: what the dancer holds and wears, as OpenXR actions: where both hands and up to eight
// trackers are, where a hand points, its buttons, and what it lets feel.
//
// Units/frames: poses in the session's base space; amplitudes 0 to 1.
// Ownership:    owns its actions and spaces; refers to the session, which must outlive it.
// Threads:      sync() on one thread; locating, reading and vibrating on any.
// Failure:      create() names what the runtime refuses. What is not there or not tracked is not
//               told; devices that appear later are.
// Source:       OpenXR 1.0, actions; XR_HTCX_vive_tracker_interaction.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time.h"
#include "producers/trackers/tracker_frame.h"
#include "producers/xr/xr_session.h"

namespace dance {

enum class XrHand : std::uint8_t { kLeft, kRight };
constexpr std::size_t kXrHands = 2;

constexpr float kMostBaseDistance_m = 1000.0f;

// Where something is, in the session's base space.
struct XrPlace {
  Eigen::Vector3f p_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf R = Eigen::Quaternionf::Identity();
};

// nullopt where it is not known, is guessed although `must_be_tracked`, or is no place at all.
std::optional<XrPlace> place_of(XrSpaceLocationFlags flags, const XrPosef& pose,
                                bool must_be_tracked);
inline std::optional<XrPlace> place_of(const XrSpaceLocation& location, bool must_be_tracked) {
  return place_of(location.locationFlags, location.pose, must_be_tracked);
}

class XrInput {
 public:
  static Result<std::unique_ptr<XrInput>> create(const XrDancerSession& session);
  ~XrInput();
  XrInput(const XrInput&) = delete;
  XrInput& operator=(const XrInput&) = delete;

  // Brings the state of all devices up to date.
  void sync();

  std::optional<XrPlace> head(XrTime time) const;
  std::optional<XrPlace> grip(XrHand hand, XrTime time) const;
  std::optional<XrPlace> aim(XrHand hand, XrTime time) const;
  std::optional<XrPlace> tracker(TrackedPoint point, XrTime time) const;
  // As of the last sync(). Whether a controller is in that hand, tracked or not.
  bool holds(XrHand hand) const;
  bool is_pressed(XrHand hand) const;
  bool is_menu_pressed(XrHand hand) const;

  // False where the hand has nothing that vibrates.
  bool vibrate(XrHand hand, float amplitude, Duration duration, float frequency_hz) const;
  void stop(XrHand hand) const;

  // Places that could not be true, and calls that the runtime refused.
  std::uint64_t bad_places() const { return bad_places_.load(std::memory_order_relaxed); }
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  struct Tracker {
    TrackedPoint point;
    XrPath path = XR_NULL_PATH;
    XrSpace space = XR_NULL_HANDLE;
  };
  // Vive's roles: hips, feet, elbows, knees, chest.
  static constexpr std::size_t kTrackers = 8;

  explicit XrInput(const XrDancerSession& session) : session_(session) {}
  Result<void> open();
  Result<XrPath> path(const std::string& text) const;
  Result<XrAction> action(const char* name, const char* title, XrActionType type, bool is_of_hands);
  Result<XrSpace> space_of(XrAction action, XrPath subaction) const;
  Result<void> open_trackers();
  Result<void> make_spaces();
  // Whether the runtime knows the profile.
  bool suggest(const char* profile,
               const std::vector<std::pair<XrAction, std::string>>& bindings) const;
  Result<void> suggest_all() const;
  std::optional<XrPlace> locate(XrSpace space, XrTime time, bool must_be_tracked) const;
  XrActionStateGetInfo state_info(XrAction action, XrHand hand) const;
  XrHapticActionInfo haptic_info(XrHand hand) const;
  bool state_of(XrAction action, XrHand hand) const;

  const XrDancerSession& session_;
  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction grip_ = XR_NULL_HANDLE, aim_ = XR_NULL_HANDLE, press_ = XR_NULL_HANDLE;
  XrAction menu_ = XR_NULL_HANDLE, haptic_ = XR_NULL_HANDLE, worn_ = XR_NULL_HANDLE;
  std::array<XrPath, kXrHands> hands_{};
  std::array<XrSpace, kXrHands> grips_{}, aims_{};
  std::array<Tracker, kTrackers> trackers_{};
  std::size_t tracker_count_ = 0;
  mutable std::atomic<std::uint64_t> bad_places_{0}, refused_{0};
};

}  // namespace dance
