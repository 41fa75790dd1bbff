// dance join: all of a house in one: manager, link and hosted producers in this process, the viewer
// beside it.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>

#include "core/base/text/guest_id_hint.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "house/dancer/session_partner.h"
#include "house/house.h"
#include "house/session_guests.h"
#include "producers/music/band/band_song.h"
#include "tunnel/invitation/open_invitation.h"
#include "viewer/scene/place.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance join 'dance://dance.example.org/salsa?…'     opens an invitation, and joins; later on too
  dance join sessions/alice.toml                     everything as the session file says
  dance join dance.example.org --guest alice --room salsa
                                                     without a file: own captures to the stage and
                                                     the room; the others predicted, in rhythm
  dance join dance.example.org --guest alice --shown-name "Alicia López"
                                                     the others see this name
  dance join sessions/alice.toml --want default=4 --want bob=1
                                                     bob in full, of the others each fourth pose
  dance join dance.example.org --guest alice --camera auto
                                                     alice dances before the first camera
  dance join dance.example.org --guest alice --headset
                                                     alice dances with a headset, on the stage
  dance join dance.example.org --guest alice --avatar me.vrm
                                                     alice is drawn so, at the others' too
  dance join dance.example.org --guest alice --voice
                                                     alice speaks, and hears the others
  dance join sessions/alice.toml --alone --partner lead
                                                     without the server; a synthetic partner
  dance join sessions/alice.toml --alone --music song.ogg --view mirror
                                                     practice with music, before a mirror
  dance join sessions/alice.toml --alone --teacher lesson.bvh --teacher-speed 0.75
                                                     beside a recorded teacher
  dance join sessions/alice.toml --watch             with alice's key, without dancing
  dance join sessions/alice.toml --no-view           without a window
)";

constexpr const char* kUsualBand = "salsa";

struct JoinOptions {
  std::string host_or_session;
  bool is_invited = false;  // by an invitation: then it is a host, whatever files are here
  std::vector<std::string> guests;
  std::vector<std::string> shown_names;
  std::string room;
  std::vector<std::string> want;
  std::vector<std::string> hear;
  std::string bus;
  std::vector<std::string> bus_captures;
  std::string camera;
  bool headset = false;
  std::vector<std::string> avatars;
  std::string partner;
  std::string music;
  std::string band;
  std::string view;
  std::string place;
  std::string teacher;
  double teacher_speed = 1.0;
  bool teacher_mirrored = false;
  bool alone = false;
  bool confirms = false;
  bool voice = false;
  bool watch = false;
  bool no_view = false;
  bool json = false;
};

Result<GuestId> guest_of(const std::string& name) {
  const auto guest = GuestId::parse(name);
  if (!guest) return fail("--guest " + guest_id_error(name));
  return *guest;
}

bool is_session_file(const JoinOptions& options) {
  const std::string& name = options.host_or_session;
  return !options.is_invited && (name.ends_with(".toml") || std::filesystem::exists(name));
}

// A click on a link is not consent: the desktop's entry for links asks here where no window can.
bool is_confirmed(const Invitation& invitation) {
  const bool sends = invitation.role != KeyKind::kListener;
  std::fprintf(stderr, "Join %s on %s as %s? %s [y/N] ",
               invitation.room.is_set() ? std::string(invitation.room.view()).c_str() : "dance",
               invitation.server().c_str(), std::string(invitation.guest.view()).c_str(),
               sends ? "The others receive your motion." : "You only watch and listen.");
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
}

// Other users of this machine see a program's arguments: its key is no longer among them.
void hide_invitations(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (is_invitation(argv[i])) std::fill(argv[i], argv[i] + std::strlen(argv[i]), '-');
}

// The invitation in the place of HOST, --guest and --room; those that are given go before it.
Result<void> use_invitation(JoinOptions& options) {
  DANCE_TRY(const Invitation invitation, parse_invitation(options.host_or_session));
  if (options.confirms && !is_confirmed(invitation))
    return fail("not confirmed: the invitation was not used, and no server was contacted");
  DANCE_TRY(const Opened opened, open_invitation(invitation));
  if (opened == Opened::kNow)
    talk::info("the invitation of {} is opened, and its key kept here", invitation.title());
  else
    talk::info("the invitation of {} was opened here before", invitation.title());
  options.host_or_session = invitation.server();
  options.is_invited = true;
  if (options.room.empty()) options.room = invitation.room.view();
  const bool dances = invitation.role != KeyKind::kListener;
  if (options.guests.empty() && dances) options.guests.emplace_back(invitation.guest.view());
  return {};
}

// A camera sees the first guest, and further ones that are named beside.
Result<void> put_before_camera(HouseConfig& session, const std::vector<GuestId>& named,
                               const std::string& device) {
  if (session.guests.empty()) return fail("--camera: who dances? name the guest with --guest");
  HostedCamera camera;
  camera.guest = session.guests.front();
  if (device != "auto") camera.device = device;
  for (const GuestId& guest : named)
    if (guest != camera.guest) camera.partners.push_back({guest, 0.0});
  if (camera.partners.size() > HostedCamera::kMostPartners)
    return fail("--camera: one camera sees four dancers at most; name fewer guests");
  // Where the session file has one for this guest, another device; a dancer that stands in for the
  // camera makes room.
  const auto is_before = [&](const GuestId& guest) {
    return guest == camera.guest ||
           std::any_of(camera.partners.begin(), camera.partners.end(),
                       [&](const auto& partner) { return partner.guest == guest; });
  };
  std::erase_if(session.producers, [&](const auto& p) { return is_before(p.guest); });
  const auto has = std::find_if(session.cameras.begin(), session.cameras.end(),
                                [&](const auto& c) { return c.guest == camera.guest; });
  if (has == session.cameras.end()) {
    session.cameras.push_back(camera);
  } else {
    has->device = camera.device;
    if (!camera.partners.empty()) has->partners = camera.partners;
  }
  return {};
}

// The first guest dances with a headset, which is the house's window too.
Result<void> put_into_headset(HouseConfig& session) {
  if (session.guests.empty()) return fail("--headset: who dances? name the guest with --guest");
  const GuestId guest = session.guests.front();
  const auto is_of = [&](const auto& it) { return it.guest == guest; };
  std::erase_if(session.producers, is_of);
  std::erase_if(session.cameras, is_of);
  std::erase_if(session.receivers, [&](const auto& it) { return it.options.guest == guest; });
  if (std::none_of(session.headsets.begin(), session.headsets.end(), is_of))
    session.headsets.emplace_back().guest = guest;
  session.view = false;
  return {};
}

Result<HouseConfig> session_of(const JoinOptions& options) {
  HouseConfig session;
  if (is_session_file(options)) {
    DANCE_TRY(session, load_session(options.host_or_session));
  } else {
    session.server = options.host_or_session;
    session.routes = default_routes();
  }
  std::vector<GuestId> guests;
  for (const std::string& name : options.guests) {
    DANCE_TRY(const GuestId guest, guest_of(name));
    guests.push_back(guest);
  }
  if (!guests.empty()) replace_guests(session, guests);
  for (const std::string& name : options.shown_names)
    if (auto set = set_shown_name(session, name); !set)
      return fail("--shown-name " + set.error().what);
  if (!options.room.empty()) session.room = options.room;
  if (!GuestId::parse(session.room))
    return fail("--room '" + session.room +
                "': a room's name is 1 to 24 characters of a-z, 0-9 and '-'");
  if (!options.want.empty()) {
    const auto interest = parse_interest(options.want);
    if (!interest) return fail("--want " + interest.error().what);
    session.interest = *interest;
  }
  if (!options.hear.empty()) {
    const auto hearing = parse_hearing(options.hear);
    if (!hearing) return fail("--hear " + hearing.error().what);
    session.hearing = *hearing;
  }
  if (!options.camera.empty())
    if (auto put = put_before_camera(session, guests, options.camera); !put)
      return tl::make_unexpected(put.error());
  if (options.headset)
    if (auto put = put_into_headset(session); !put) return tl::make_unexpected(put.error());
  for (const std::string& text : options.avatars) {
    AvatarOfGuest wish = parse_avatar_of_guest(text);
    if (!wish.guest.is_set() && session.guests.empty())
      return fail("--avatar: who dances? name the guest with --guest");
    if (!wish.guest.is_set()) wish.guest = session.guests.front();
    std::erase_if(session.avatars, [&](const auto& it) { return it.guest == wish.guest; });
    session.avatars.push_back({wish.guest, {wish.what, "", "", 1.0}});
  }
  if (options.voice && !session.voice) {
    if (session.guests.empty()) return fail("--voice: who speaks? name the guest with --guest");
    session.voice.emplace().guest = session.guests.front();
  }
  if (options.voice) session.voice->enabled = true;
  if (options.watch || session.watch) only_watch(session);
  if (options.alone) dance_alone(session);
  if (!options.partner.empty()) {
    if (auto added = add_partner(session, options.partner); !added)
      return fail("--partner " + added.error().what);
  }
  if (!options.music.empty()) practise_to(session, options.music);
  if (!options.bus.empty()) session.bus = options.bus;
  for (const std::string& name : options.bus_captures) {
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("--bus-captures '" + name + "': " + kGuestIdRule);
    session.bus_captures.push_back(*guest);
  }
  if (options.no_view) session.view = false;
  if (!options.teacher.empty() && !session.view)
    return fail("--teacher stands in the window only; leave out --no-view, or set view = true");
  // Without a window the house is a service, which plays no band unless it is asked to.
  const std::string band = options.band.empty() && session.view ? kUsualBand : options.band;
  if (!band.empty() && band != kNoBand) {
    if (!band_style_of(band))
      return fail("--band '" + band + "': the band plays " + band_style_names() + ", or none");
    let_band_play(session, band);
  }
  if (auto checked = check_guests(session); !checked) return tl::make_unexpected(checked.error());
  return session;
}

// The viewer's panels save into the session file, where there is one.
std::vector<std::string> viewer_arguments(const JoinOptions& options, const HouseConfig& session,
                                          const std::string& bus_url) {
  std::vector<std::string> arguments{"--bus", bus_url};
  if (!options.view.empty()) arguments.insert(arguments.end(), {"--view", options.view});
  if (!options.view.empty() && !session.guests.empty())
    arguments.insert(arguments.end(), {"--focus", std::string(session.guests.front().view())});
  arguments.insert(arguments.end(),
                   {"--place", options.place.empty() ? session.window.place : options.place});
  if (is_session_file(options))
    arguments.insert(arguments.end(), {"--session", options.host_or_session});
  if (options.teacher.empty()) return arguments;
  arguments.insert(arguments.end(), {"--teacher=" + options.teacher,
                                     fmt::format("--teacher-speed={:g}", options.teacher_speed)});
  if (options.teacher_mirrored) arguments.emplace_back("--teacher-mirrored");
  if (!session.guests.empty())
    arguments.insert(arguments.end(), {"--pupil", std::string(session.guests.front().view())});
  return arguments;
}

Result<void> run_join(JoinOptions options) {
  if (is_invitation(options.host_or_session)) {
    if (auto used = use_invitation(options); !used) return used;
  }
  DANCE_TRY(const HouseConfig session, session_of(options));
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto house, House::open(session, *poller));
  std::unique_ptr<ChildProcess> viewer;
  if (session.view) {
    DANCE_TRY(
        ChildProcess started,
        ChildProcess::start({program_folder() + "/dance-view",
                             viewer_arguments(options, session, house->bus().url()), "", ""}));
    viewer = std::make_unique<ChildProcess>(std::move(started));
    poller->add_timer(mono_now() + Duration::ms(200), [&](MonoTime now) {
      if (!viewer->has_ended()) return now + Duration::ms(200);
      if (viewer->ended_well()) {
        poller->stop();  // the window was closed
        return MonoTime();
      }
      talk::warn(
          "the viewer {}; the house goes on. `dance view --bus \"{}\"` opens it again, and with "
          "--no-view it is not opened",
          viewer->exit_text(), house->bus().url());
      return MonoTime();
    });
  }
  // As when a window is closed.
  poller->add_timer(mono_now() + Duration::ms(200), [&](MonoTime now) {
    if (!house->have_headsets_left()) return now + Duration::ms(200);
    poller->stop();
    return MonoTime();
  });
  talk::info("the house is open on {}; Ctrl-C ends it", house->bus().url());
  poller->run();
  if (options.json) std::printf("%s\n", house->report_json(mono_now()).c_str());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::JoinOptions options;
  dance::CommandLine line("All of a house in one: manager, link, hosted producers, viewer.",
                          "dance join");
  line.add("HOST|SESSION|INVITATION", options.host_or_session,
           "a session file (.toml), the server's HOST[:PORT], or the link of an invitation, in "
           "quotes")
      .required();
  line.add("--guest", options.guests, "who dances here, instead of the session file's guests")
      .guest_name();
  line.add(
      "--shown-name", options.shown_names,
      "the name that people see instead of the first guest's, as \"Ana López\"; GUEST=NAME for "
      "another guest; may be repeated");
  line.add("--room", options.room, "which room, instead of the session file's");
  line.add("--want", options.want,
           "how many of a guest's poses come here, instead of the session file's want: NAME=1 "
           "every one, "
           "NAME=N at most every N-th, NAME=0 none; default=N for all who are not named; may be "
           "repeated");
  line.add(
      "--hear", options.hear,
      "whose voices come here, instead of the session file's hear: NAME=0 not this guest's, NAME=1 "
      "this guest's; default=0 nobody's who is not named; may be repeated");
  line.add("--camera", options.camera,
           "a camera sees the first guest, and those that further --guest name: auto, /dev/videoN, "
           "a number or a "
           "video; instead of what "
           "the session file says");
  line.add_flag("--headset", options.headset,
                "the first guest dances with a headset and sees the stage in it, as dance headset "
                "does; instead of the viewer");
  line.add(
      "--avatar", options.avatars,
      "how the first guest is drawn, instead of what the session file says: a file (.vrm, .glb), a "
      "name that dance avatar list shows, or words of a look; NAME=AVATAR for another guest");
  line.add_flag("--voice", options.voice,
                "the first guest speaks with the others and hears them, as dance voice does");
  line.add_flag("--watch", options.watch,
                "only watches: nobody of this house dances or speaks in the room");
  line.add_flag("--alone", options.alone, "without the session file's server: nobody else comes");
  line.add(
      "--partner", options.partner,
      "one more dancer in this house: lead or follow (a synthetic one), or a file (.bvh, .glb, "
      ".lcm)");
  line.add("--music", options.music,
           "plays this file over and over, instead of the session file's music");
  line.add("--band", options.band,
           "style of the house band, which plays where neither the session file nor the room has "
           "other music: " +
               dance::band_style_names() + ", none; with a window it is salsa");
  line.add("--view", options.view, "the viewer's view, of the first guest: as dance view --view")
      .one_of({"orbit", "follow", "mirror", "first-person", "compare", "grid"});
  std::vector<std::string> places;
  for (const dance::PlaceName& it : dance::kPlaceNames) places.emplace_back(it.option);
  line.add("--place", options.place, "where the viewer's stage is: as dance view --place")
      .one_of(places);
  line.add("--teacher", options.teacher,
           "a recording whose dancer stands beside the first guest in the window, and nowhere "
           "else: as dance view --teacher");
  line.add("--teacher-speed", options.teacher_speed, "from half to full speed, as 0.75")
      .range(0.5, 1.0);
  line.add_flag("--teacher-mirrored", options.teacher_mirrored, "left is right");
  line.add("--bus", options.bus, "LCM URL of the house's bus, instead of the session file's");
  line.add("--bus-captures", options.bus_captures,
           "guest whose captures are accepted from the bus, for programs that are not part of "
           "DanceGraph, besides the guests that the session file names; any user of this machine "
           "can "
           "then dance and speak as this guest; may be repeated")
      .guest_name();
  line.add_flag(
      "--confirm", options.confirms,
      "asks on the terminal before it opens an invitation, as for a link that was clicked");
  line.add_flag("--no-view", options.no_view, "no viewer");
  line.add_flag("--json", options.json, "write what was counted to stdout at the end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] {
    dance::hide_invitations(argc, argv);
    return dance::run_join(options);
  });
}
