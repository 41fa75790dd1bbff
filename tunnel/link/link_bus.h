// Puts a link on a house's port. Captures of this house go to the link; what the link receives of
// other guests goes to POSE/guest/<id> and its like; the room's music and scene go to MUSIC/room
// and SCENE/room; further channels go to <channel>/guest/<id>, over the bus. Whose captures and
// requests the port lets through is the port's matter (core/control/house_inputs.h).
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
#include "tunnel/link/voice_signs.h"
#include "tunnel/policy/hearing_wishes.h"
#include "tunnel/policy/interest_wishes.h"

namespace dance {

class LinkBus {
 public:
  // `bus` carries further channels, the port of `captures` all the rest.
  LinkBus(Bus& bus, Captures& captures, std::uint64_t clock_id)
      : bus_(bus), captures_(captures), port_(captures.port()), clock_id_(clock_id) {}

  // The handlers to open the link with; the caller adds on_state, on_refused and those for the
  // coming and going of guests.
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
  // Faces, the signs of voices and profiles travel as messages of further channels, so that servers
  // and older links need no support for them. Adds their rules in front of those that the link is
  // opened with, because the first rule that names a channel applies.
  static void add_own_rules(std::vector<ChannelRule>& rules);
  // Sends the channels that the rules let out, too.
  void send_channels(const std::vector<ChannelRule>& rules);
  // While guests of this house send HEARING/local, receives only voices that they request, among
  // those that `own` lets in.
  void follow_hearing(const Hearing& own);
  // While windows of this house send INTEREST/local, receives only poses that one of them shows,
  // among those that `own` lets in. Call it after follow_hearing().
  void follow_interest(const Interest& own);
  // HOUSE_LINK/local says how the link stands. After the caller's own handlers were added.
  void tell_status(LinkHandlers& handlers);
  // The link asks the server to remove guests whom a host of this house names with REMOVAL/local.
  void follow_removals();
  void forget(const GuestId& guest);
  // STATS/link, and the states of the others and of the room again, for programs that start late.
  // Call once a second.
  void publish_second(MonoTime now);

 private:
  // What is known of one guest of another house.
  struct Known {
    std::tuple<std::optional<TimedSkeleton>, std::optional<Avatar>, std::optional<AvatarFile>,
               std::optional<Style>, std::optional<Placement>, std::optional<VoiceState>,
               std::optional<Profile>>
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
  void publish_status(MonoTime now);
  void send_face(const GuestId& guest, const Face& face, MonoTime now);
  void on_face(const GuestId& guest, wire::Bytes message, MonoTime now);
  void send_voice_signs_of(const GuestId& guest);
  void send_voice_sign(const GuestId& guest, std::uint8_t sign, MonoTime now);
  void on_voice_sign(const GuestId& guest, wire::Bytes message, MonoTime now);
  void keep_own_profile(const GuestId& guest, const Profile& profile, MonoTime now);
  void send_profile(const GuestId& guest, Profile profile, MonoTime now);
  void send_profiles(MonoTime now);
  void on_profile(const GuestId& guest, wire::Bytes message, MonoTime now);
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
  VoiceSigns voice_signs_;
  std::map<GuestId, Profile> own_profiles_;  // of guests of this house
  Hearing own_hearing_;
  HearingWishes wishes_;
  std::optional<Interest> own_interest_;  // not set: windows are not asked
  InterestWishes hidden_;
  LinkStatus status_;
};

}  // namespace dance
