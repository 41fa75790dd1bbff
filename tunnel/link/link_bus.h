// Puts a link on a house's port: what this house captures goes to the link, and what the link hears
// of the others goes to POSE/guest/<id> and its like; the room's music and scene to MUSIC/room and
// SCENE/room; further channels to <channel>/guest/<id>, over the bus.
//
// Units/frames: as in core/bus; one clock for both.
// Ownership:    bus, captures (and their port) and link must outlive it; make it before the link,
//               whose handlers it gives.
// Threads:      the poller's.
// Failure:      none of its own; link and bus count.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/bus/bus.h"
#include "core/bus/captures.h"
#include "tunnel/link/link.h"
#include "tunnel/link/link_avatars.h"
#include "tunnel/link/link_status.h"
#include "tunnel/policy/hearing_wishes.h"
#include "tunnel/policy/interest_wishes.h"

namespace dance {

class LinkBus {
 public:
  // `bus` carries further channels, the port of `captures` all the rest.
  LinkBus(Bus& bus, Captures& captures, std::uint64_t clock_id)
      : bus_(bus), captures_(captures), port_(captures.port()), clock_id_(clock_id) {}

  // What the link is to be opened with; on_state, on_refused and the guests' coming and going are
  // the caller's to add.
  LinkHandlers handlers();
  void attach(Link& link) {
    link_ = &link;
    if (avatars_ != nullptr) avatars_->attach(link);
  }
  // Before handlers(): avatars' files are offered and fetched; it must outlive this.
  void use_avatars(LinkAvatars& avatars) { avatars_ = &avatars; }
  // From now on what is captured and chosen by this guest goes to the link; by everybody where the
  // guest is not set.
  void send_signals_of(const GuestId& guest);
  // Faces travel as messages of a further channel, so that no server and no older link has to know
  // them. To the rules that the link is opened with: in front, as the first that names a channel
  // counts.
  static void add_face_rule(std::vector<ChannelRule>& rules);
  // And the channels that the rules let out.
  void send_channels(const std::vector<ChannelRule>& rules);
  // Of the voices that `own` lets in, only those come that a guest of this house wants, while any
  // says so on HEARING/local.
  void follow_hearing(const Hearing& own);
  // And of the poses that `own` lets in those that a window of this house shows, while any says so
  // on INTEREST/local. After follow_hearing().
  void follow_interest(const Interest& own);
  // HOUSE_LINK/local says how the link stands. After the caller's own handlers were added.
  void tell_status(LinkHandlers& handlers);
  // The link asks the server to remove whom a host of this house names on REMOVAL/local.
  void follow_removals();
  void forget(const GuestId& guest);
  // STATS/link, and the states of the others and of the room again, for programs that start late.
  // Call once a second.
  void publish_second(MonoTime now);

 private:
  // What is known of one guest of another house.
  struct Known {
    std::tuple<std::optional<TimedSkeleton>, std::optional<Avatar>, std::optional<AvatarFile>,
               std::optional<Style>, std::optional<Placement>>
        states;
    std::map<std::string, std::vector<std::uint8_t>> channels;  // of class state, by full name
  };
  template <class T>
  auto publisher(Where where);
  template <class T>
  auto keeper();
  template <class... Ts>
  void send_each(const GuestId& guest);
  void publish_traffic(MonoTime now);
  void tell_wishes(MonoTime now);
  bool is_of_now(std::uint64_t clock_id, MonoTime said, MonoTime now) const;
  void publish_status(MonoTime now);
  void send_face(const GuestId& guest, const Face& face, MonoTime now);
  void on_face(const GuestId& guest, wire::Bytes message, MonoTime now);
  void on_channel(const GuestId& guest, std::string_view name, ChannelClass kind,
                  wire::Bytes message);

  Bus& bus_;
  Captures& captures_;
  SignalPort& port_;
  std::uint64_t clock_id_;
  Link* link_ = nullptr;
  LinkAvatars* avatars_ = nullptr;
  std::map<GuestId, Known> known_;
  std::optional<std::pair<GuestId, Scene>> scene_;
  std::vector<ChannelRule> rules_;
  std::uint32_t faces_heard_ = 0;
  Hearing own_hearing_;
  HearingWishes wishes_;
  std::optional<Interest> own_interest_;  // not set: windows are not asked
  InterestWishes hidden_;
  LinkStatus status_;
};

}  // namespace dance
