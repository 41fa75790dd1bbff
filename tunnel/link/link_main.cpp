// dance link: joins a house's bus to a room on a server.

#include <cstdio>
#include <memory>

#include "core/control/house_inputs.h"
#include "core/net/mono_clock.h"
#include "core/program/message_throttle.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "tunnel/link/find_server.h"
#include "tunnel/link/link_bus.h"
#include "tunnel/link/link_report.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance link --guest alice                                room 'dance' on this machine's server
  dance link --server dance.example.org --room salsa --guest alice
  dance link --server 192.0.2.7:7400 --room salsa         every dancer captured in this house
  dance link --server dance.example.org --room salsa --listen-only
                                                          receives only, sends nothing
  dance link --guest alice --want default=4 --want bob=1  all of bob, every fourth of the others
  dance link --guest bob --bus 'udpm://239.255.76.67:7668?ttl=0'
                                                          a second house on this machine
  dance link --guest alice --channel 'LIGHT/desk class=state layout=n:i32,f32[n]'
                                                          also forwards a light desk's channel
)";

constexpr Duration kSecond = Duration::s(1);

struct LinkProgramOptions {
  std::string server = "127.0.0.1:7400";
  std::string room = "dance";
  std::vector<std::string> guests;
  std::string bus;
  LinkKeySource key;
  double quality_mm = LinkOptions().quality_m * 1e3;
  double pose_bytes_per_second = 0.0;
  double avatar_bytes_per_second = LinkOptions().file_bytes_per_second;
  std::vector<std::string> want;
  std::vector<std::string> hear;
  std::vector<std::string> channels;
  std::vector<std::string> bus_captures;
  bool listen_only = false;
  bool json = false;
};

Result<LinkOptions> checked(const LinkProgramOptions& given) {
  LinkOptions options;
  const auto room = wire::RoomName::parse(given.room);
  if (!room)
    return fail("--room '" + given.room +
                "': a room's name is 1 to 24 characters of a-z, 0-9 and "
                "'-'");
  options.room = *room;
  for (const std::string& name : given.guests) {
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("--guest '" + name + "': " + kGuestIdRule);
    if (options.guests.contains(*guest)) return fail("--guest '" + name + "' is named twice");
    if (!options.guests.try_push(*guest)) return fail("--guest: a link has at most 16 guests");
  }
  if (given.listen_only && !given.guests.empty())
    return fail("--listen-only brings no guests: leave out --guest, or --listen-only");
  options.listen_only = given.listen_only;
  const auto interest = parse_interest(given.want);
  if (!interest) return fail("--want " + interest.error().what);
  options.interest = *interest;
  const auto hearing = parse_hearing(given.hear);
  if (!hearing) return fail("--hear " + hearing.error().what);
  options.hearing = *hearing;
  DANCE_TRY(options.channels, parse_channel_rules(given.channels));
  options.clock_id = this_clock_id();
  options.quality_m = given.quality_mm * 1e-3;
  options.pose_bytes_per_second = given.pose_bytes_per_second;
  options.file_bytes_per_second = given.avatar_bytes_per_second;
  return options;
}

Result<std::vector<GuestId>> bus_captures_of(const LinkProgramOptions& given) {
  std::vector<GuestId> guests;
  for (const std::string& name : given.bus_captures) {
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("--bus-captures '" + name + "': " + kGuestIdRule);
    guests.push_back(*guest);
  }
  return guests;
}

void add_talk(LinkHandlers& handlers, LinkBus& link_bus, const LinkProgramOptions& options,
              const wire::RoomName& room) {
  const auto troubles = std::make_shared<MessageThrottle>();
  handlers.on_state = [&options, troubles](LinkState state, MonoTime) {
    if (state == LinkState::kConnected) {
      troubles->forget();
      talk::info("in room '{}' on {}", options.room, options.server);
    }
    if (state == LinkState::kLapsed)
      talk::warn("the server {} is silent; poses are dropped until it answers", options.server);
  };
  handlers.on_guest_joined = [](const GuestId& guest, MonoTime) {
    talk::info("{} is here", guest.view());
  };
  handlers.on_guest_left = [&link_bus](const GuestId& guest, MonoTime) {
    link_bus.forget(guest);
    talk::info("{} has left", guest.view());
  };
  handlers.on_room_state_refused = [](wire::StateKind kind, wire::StateVerdict verdict) {
    talk::info("{}", room_state_line(kind, verdict));
  };
  handlers.on_other_server = [](const Address& address) {
    talk::info("{}", other_server_line(address));
  };
  handlers.on_no_answer = [troubles](const Address& address) {
    troubles->warn(no_answer_line(address), mono_now());
  };
  handlers.on_new_address = [&options](const Address& address) {
    talk::info("{}", new_address_line(options.server, address));
  };
  handlers.on_unknown_name = [troubles](const std::string& why) {
    troubles->warn(unknown_name_line(why), mono_now());
  };
  handlers.on_no_entry = [&options, troubles](SealTrouble trouble) {
    troubles->warn(no_entry_line(trouble, options.server), mono_now());
  };
  handlers.on_refused = [room, troubles](const wire::RefusalNotice& refusal, MonoTime now) {
    troubles->warn(refusal_line(refusal, room), now);
  };
}

Result<void> run_link(const LinkProgramOptions& given) {
  DANCE_TRY(LinkOptions options, checked(given));
  // Channels come of no guest of whom no pose is wanted.
  const bool lets_any = lets_any_in(options.channels);
  LinkBus::add_own_rules(options.channels);
  const GuestId first = options.guests.empty() ? GuestId() : options.guests[0];
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  options.look_up = look_up_of(given.server);
  DANCE_TRY(const FoundServer server,
            find_server(given.server, options.look_up, options.room, first, given.key, *poller));
  if (server.addresses.empty()) talk::warn("{}", unknown_name_line(server.why));
  DANCE_TRY(auto bus, Bus::open(bus_url_or_default(given.bus)));
  HouseInputs::Options taken;
  taken.bus_url = bus->url();
  DANCE_TRY(taken.from_bus, bus_captures_of(given));
  const auto refusals = std::make_shared<MessageThrottle>();
  taken.on_refused = [refusals](const GuestId& guest) {
    refusals->warn(refused_poses_line(guest), mono_now());
  };
  HouseInputs inputs(*bus, *bus, std::move(taken), *poller);
  if (!inputs.problem().empty()) talk::warn("{}", no_house_socket_line(inputs.problem()));
  Captures captures(inputs, options.clock_id);
  LinkBus link_bus(*bus, captures, options.clock_id);
  DANCE_TRY(WakeEvent avatars_wake, WakeEvent::create());
  LinkAvatars avatars(AvatarStore::of_user(), std::move(avatars_wake), *poller,
                      [](const std::string& line) { talk::info("{}", line); });
  link_bus.use_avatars(avatars);
  LinkHandlers handlers = link_bus.handlers();
  add_talk(handlers, link_bus, given, options.room);
  link_bus.tell_status(handlers);
  DANCE_TRY(auto link,
            Link::open(server.addresses, server.key, options, std::move(handlers), *poller));
  link_bus.attach(*link);
  if (options.guests.empty() && !options.listen_only) link_bus.send_signals_of(GuestId());
  for (const GuestId& guest : options.guests) link_bus.send_signals_of(guest);
  if (!options.listen_only) link_bus.send_channels(options.channels);
  link_bus.follow_hearing(options.hearing);
  if (!lets_any) link_bus.follow_interest(options.interest);
  link_bus.follow_removals();
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  const MonoTime begin = mono_now();
  poller->add_timer(begin + kSecond, [&](MonoTime now) {
    link_bus.publish_second(now);
    return now + kSecond;
  });
  talk::info("asks {} for room '{}'; Ctrl-C ends it", given.server, given.room);
  poller->run();
  poller->unwatch(bus->fd());
  if (given.json)
    std::printf("%s\n", link_report_json(*link).c_str());
  else
    talk::info("{} poses sent, {} delivered{}", link->counters().poses_sent,
               link->counters().poses_delivered, seal_trouble_text(link->seal_counters()));
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::LinkProgramOptions options;
  dance::CommandLine line(
      "A house's link: its guests' poses go to the room, the others' come to its bus.",
      "dance link");
  line.add("--server", options.server, "HOST or HOST:PORT of `dance server`").shows_default();
  line.add("--room", options.room, "which room").shows_default();
  line.add("--guest", options.guests,
           "whose captures go to the room, may be repeated; none = everybody captured here")
      .guest_name();
  line.add("--want", options.want,
           "how many of a guest's poses come here: NAME=1 every one, before all others where the "
           "line is narrow; NAME=N at most every N-th, NAME=0 "
           "none; default=N for all who are not named; may be repeated");
  line.add("--hear", options.hear,
           "whose voices come here: NAME=0 not this guest's, NAME=1 this guest's; default=0 "
           "nobody's who is not named; may be repeated");
  line.add_flag("--listen-only", options.listen_only,
                "hears the room and sends nothing of this house");
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add("--bus-captures", options.bus_captures,
           "guest whose captures are accepted from the bus, for programs that are not part of "
           "DanceGraph; any user of this machine can then dance and speak as this guest; may be "
           "repeated")
      .guest_name();
  line.add("--quality", options.quality_mm,
           "millimetres that no joint is off by more at the others'")
      .range(0.125, 20.0)
      .shows_default();
  line.add("--rate", options.pose_bytes_per_second,
           "bytes a second that the poses of a guest may take, without headers; where they take "
           "more, joints are off "
           "by up to 5 mm; 0 = whatever --quality takes")
      .range(0.0, 1e6)
      .shows_default();
  line.add(
          "--avatar-rate", options.avatar_bytes_per_second,
          "bytes a second that files of avatars may take, each way, beside the poses; 0 = none are "
          "sent or fetched")
      .range(0.0, 1e7)
      .shows_default();
  line.add("--key-file", options.key.key_file,
           "file of keys to servers (else where dance key keeps them)");
  line.add("--certificate", options.key.certificates.chain,
           "PEM file with this house's certificate, instead of a key");
  line.add("--private-key", options.key.certificates.private_key, "PEM file of its private key");
  line.add("--authorities", options.key.certificates.authorities,
           "PEM file of those who may sign the server's certificate (else the system's)");
  line.add("--channel", options.channels,
           "a further channel that rides along, or is let in, as 'NAME class=… layout=…' "
           "(docs/channels.md); may be repeated");
  line.add_flag("--json", options.json, "write a summary to stdout at the end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_link(options); });
}
