// House: all of a house's routing in one process: bus, signal manager, link to the server, hosted
// producers and consumers, from one session. They meet on one port (house/house_port.h): a pose
// from the link or from a hosted producer reaches the stage without a bus hop; it goes over the bus
// as well, for recorders and other programs.
//
// Units/frames: times of this house's clock.
// Ownership:    owns its parts; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names what cannot be had (bus, server's name, motion file) and the cure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "consumers/consumer_table.h"
#include "core/bus/bus.h"
#include "core/control/house_inputs.h"
#include "core/control/house_publisher.h"
#include "core/net/poller.h"
#include "core/program/message_throttle.h"
#include "haptics/haptic_control.h"
#include "house/dancer/hosted_salsa.h"
#include "house/headset/house_headset.h"
#include "house/house_avatars.h"
#include "house/house_camera.h"
#include "house/house_haptics.h"
#include "house/house_music.h"
#include "house/house_port.h"
#include "house/house_profiles.h"
#include "house/session.h"
#include "house/voice/house_voice.h"
#include "manager/manager.h"
#include "producers/capture_sink.h"
#include "producers/dancer_feed.h"
#include "producers/receive/pose_receiver.h"
#include "tunnel/link/link.h"
#include "tunnel/link/link_bus.h"

namespace dance {

class House {
 public:
  static Result<std::unique_ptr<House>> open(const HouseConfig& session, Poller& poller);
  ~House();
  House(const House&) = delete;
  House& operator=(const House&) = delete;

  Bus& bus() { return *bus_; }
  // There are dancers with headsets, and all of them have left by their panels.
  bool have_headsets_left() const;
  bool is_connected() const { return link_ && link_->is_connected(); }
  // What the house counted, as one JSON object: per remote guest, link and manager.
  std::string report_json(MonoTime now);

 private:
  House(const HouseConfig& session, Poller& poller);
  void open_inputs();
  Result<void> open_link();
  void open_voice();
  Result<void> open_avatars();
  Result<void> open_producers();
  void show_others_to(PlacedSalsa& salsa);
  Result<void> open_consumers();
  void flush_consumers(MonoTime now);
  void open_haptics();
  void open_haptic_controls();
  void add_talk(LinkHandlers& handlers);

  HouseConfig session_;
  Poller& poller_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<HousePublisher> publisher_;  // to the bus, and to links that run by themselves
  std::unique_ptr<HousePort> port_;
  std::unique_ptr<HouseInputs> inputs_;
  std::unique_ptr<PortCaptureSink> captures_;  // of hosted producers
  std::unique_ptr<Captures> link_captures_;
  std::unique_ptr<LinkAvatars> link_avatars_;
  std::unique_ptr<LinkBus> link_bus_;
  std::unique_ptr<Link> link_;
  std::unique_ptr<Manager> manager_;
  std::vector<std::unique_ptr<DancerFeed>> feeds_;
  std::vector<PlacedSalsa*> placed_;  // of feeds_, until the house has joined its room
  std::vector<std::unique_ptr<ProgramControl>> role_controls_;
  std::vector<std::unique_ptr<PoseReceiver>> receivers_;
  struct Listening {
    std::unique_ptr<PoseConsumer> consumer;
    bool has_failed = false;
  };
  std::vector<Listening> consumers_;
  std::vector<std::unique_ptr<HapticFeed>> haptics_;
  std::vector<std::unique_ptr<HouseHaptics>> haptic_programs_;
  std::vector<std::unique_ptr<HapticControl>> haptic_controls_;  // one of each guest
  std::unique_ptr<HouseAvatars> avatars_;
  std::unique_ptr<HouseProfiles> profiles_;
  std::unique_ptr<HouseMusic> music_;
  std::unique_ptr<HouseVoice> voice_;
  std::vector<std::unique_ptr<HouseCamera>> cameras_;
  std::vector<std::unique_ptr<HouseHeadset>> headsets_;
  MessageThrottle troubles_;  // of the link
};

}  // namespace dance
