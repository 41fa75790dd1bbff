// Puts a link on a house's bus: what this house captures goes to the link, and what the link hears
// of the others goes to POSE/guest/<id> and its like; the room's music and scene to MUSIC/room and
// SCENE/room; further channels to <channel>/guest/<id>. Captures that bear no musical time get this
// house's.
//
// Units/frames: as in core/bus; one clock for both.
// Ownership:    bus and link must outlive it; make it before the link, whose handlers it gives.
// Threads:      the poller's.
// Failure:      none of its own; link and bus count.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "core/pose/music_tag.h"
#include "tunnel/link/link.h"

namespace dance {

class LinkBus {
 public:
  LinkBus(Bus& bus, std::uint64_t clock_id) : bus_(bus), clock_id_(clock_id), tag_(clock_id) {}

  // What the link is to be opened with; on_state, on_refused and the guests' coming and going are
  // the caller's to add.
  LinkHandlers handlers();
  void attach(Link& link) { link_ = &link; }
  // From now on this guest's captures go to the link; everybody's where the guest is not set.
  void send_captures_of(const GuestId& guest);
  // And so what this guest wishes for and looks like.
  void send_states_of(const GuestId& guest);
  // And the channels that the rules let out.
  void send_channels(const std::vector<ChannelRule>& rules);
  void forget(const GuestId& guest);
  // STATS/link, and the states of the others and of the room again, as who starts late must hear
  // them. Call once a second.
  void publish_second(MonoTime now);

 private:
  // What is known of one guest of another house.
  struct Known {
    std::optional<Skeleton> skeleton;
    std::optional<Avatar> avatar;
    std::optional<Style> style;
    std::optional<Placement> placement;
    std::map<std::string, std::vector<std::uint8_t>> channels;  // of class state, by full name
  };
  template <class Message>
  void publish_known(Signal signal, const GuestId& guest, std::optional<Message>& message,
                     MonoTime now);
  template <class Message>
  auto publisher(Signal signal, std::optional<Message> Known::*place);
  void on_channel(const GuestId& guest, std::string_view name, ChannelClass kind,
                  wire::Bytes message);

  Bus& bus_;
  std::uint64_t clock_id_;
  MusicTag tag_;
  bool hears_beats_ = false;
  Link* link_ = nullptr;
  std::map<GuestId, Known> known_;
  std::optional<std::pair<GuestId, Scene>> scene_;
  std::vector<ChannelRule> rules_;
};

}  // namespace dance
