// HeadsetCapture: a headset's dancer onto the bus, as direct as it can be: in a thread of its own,
// so many times a second, the devices are asked where they are now, the body is solved, and
// published. What is felt goes the other way in the same thread.
//
// Units/frames: capture times are the moments that the runtime was asked for, in this house's
//               clock.
// Ownership:    owns bus, poll loop and thread; the destructor ends the thread. Refers to session
//               and input, which must outlive it.
// Threads:      start() on the owner's; request…() and told() on any one other thread.
// Failure:      start() names what cannot be had. Without a head nothing is published.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "core/base/histogram.h"
#include "core/base/latest.h"
#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/net/poller.h"
#include "haptics/haptic_feed.h"
#include "headset/capture/free_spot.h"
#include "producers/receive/received_dancer.h"
#include "producers/xr/xr_dancer.h"

namespace dance {

struct HeadsetCaptureOptions {
  GuestId guest;
  std::string bus_url;
  double rate_hz = 90.0;
  XrSpot spot;
  TrackerBody::Options body;
  bool haptics = true;
  HapticMakerOptions felt;
  HapticPlayerOptions player;
};

// What outlives a session: a headset that went away comes back to the same body, and its dancer to
// where the head was. The runtime's space may be another one then.
struct HeadsetMemory {
  std::optional<XrSpot> spot;
  std::optional<CalibrationValues> body;
};

// What the display needs of the capture.
struct HeadsetTold {
  XrPlacement placement;
  bool is_placed = false;
  CalibrationValues body;
  float t_pose_progress = 0.0f;
  bool awaits_t_pose = false;
  std::uint32_t tracked = 0;    // a bit for each TrackedPoint
  bool sees_body = false;       // a whole one
  std::uint32_t jumps = 0;      // how often the dancer was put elsewhere
  std::uint32_t recentres = 0;  // of the runtime's space, that the placement is of
  std::uint32_t lost = 0;       // a bit for each TrackedPoint that was there and is gone for long
  std::array<bool, kXrHands> is_pressed{}, is_menu_pressed{};
};

class HeadsetCapture {
 public:
  static Result<std::unique_ptr<HeadsetCapture>> start(const XrDancerSession& session,
                                                       XrInput& input,
                                                       const HeadsetCaptureOptions& options,
                                                       const HeadsetMemory& memory);
  ~HeadsetCapture();
  HeadsetCapture(const HeadsetCapture&) = delete;
  HeadsetCapture& operator=(const HeadsetCapture&) = delete;

  void request_recentre() { recentre_asked_.store(true, std::memory_order_release); }
  void request_t_pose() { t_pose_asked_.store(true, std::memory_order_release); }
  // nullptr: nothing new since the last call.
  const HeadsetTold* told() { return told_.take(); }
  // Ends the thread; what the next session begins with.
  HeadsetMemory stop();
  // After stop(): one line for people.
  std::string summary() const;

 private:
  HeadsetCapture(const XrDancerSession& session, XrInput& input,
                 const HeadsetCaptureOptions& options, const HeadsetMemory& memory);
  Result<void> open();
  void run();
  MonoTime tick(MonoTime now);
  void place(XrTime time, MonoTime moment);
  void follow_moves(MonoTime moment);
  void keep_spot(const XrPlace& head, MonoTime moment);
  // Somebody wears it, as far as can be told.
  bool is_worn(MonoTime moment);
  void publish(MonoTime captured);
  void tell();
  void note_losses(MonoTime now);

  const XrDancerSession& session_;
  XrInput& input_;
  HeadsetCaptureOptions options_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<HousePublisher> port_;
  std::unique_ptr<PortCaptureSink> sink_;
  std::unique_ptr<ReceivedDancer> received_;
  std::unique_ptr<HapticFeed> felt_;
  XrSensors sensors_;
  XrDancer dancer_;
  XrSight sight_;
  Pose pose_;
  HeadsetTold now_;
  std::optional<XrSpaceMove> move_;         // that is still to come
  std::optional<XrSpot> spot_, next_spot_;  // of the head, some moments ago and after that
  MonoTime spot_kept_;
  Eigen::Vector3f rested_at_m_ = Eigen::Vector3f::Zero();
  MonoTime moved_;  // when the head was last seen to
  std::array<MonoTime, kTrackedPointCount> seen_{};
  FreeSpot others_;
  MonoTime begun_, next_;
  Histogram delay_;  // from the moment asked for to what was published
  std::uint64_t poses_ = 0, without_head_ = 0, unworn_ = 0;
  Latest<HeadsetTold> told_;
  std::atomic<bool> recentre_asked_{false}, t_pose_asked_{false}, ends_{false};
  std::thread thread_;
};

}  // namespace dance
