#include "house/session_guests.h"

#include <algorithm>
#include <utility>

#include "core/base/text/plain_text.h"

namespace dance {
namespace {

bool is_one_of(const std::vector<GuestId>& guests, const GuestId& guest) {
  return std::find(guests.begin(), guests.end(), guest) != guests.end();
}

std::string names_of(const std::vector<GuestId>& guests) {
  std::string names;
  for (const GuestId& guest : guests)
    names += (names.empty() ? "there are: " : ", ") + std::string(guest.view());
  return names;
}

// Whom the house has on its stage of its own.
std::vector<GuestId> dancers_of(const HouseConfig& session) {
  std::vector<GuestId> dancers = session.guests;
  const auto add = [&](const GuestId& guest) {
    if (guest.is_set() && !is_one_of(dancers, guest)) dancers.push_back(guest);
  };
  for (const HostedProducer& producer : session.producers) add(producer.guest);
  for (const HostedReceiver& receiver : session.receivers) add(receiver.options.guest);
  for (const HostedHeadset& headset : session.headsets) add(headset.guest);
  for (const HostedCamera& camera : session.cameras) {
    add(camera.guest);
    for (const HostedCamera::Partner& partner : camera.partners) add(partner.guest);
  }
  for (const Route& route : session.routes)
    if (route.from.where == Where::kCapture) add(route.to.guest);
  return dancers;
}

std::string trouble_of(const std::vector<GuestId>& guests, const GuestId& guest,
                       std::string_view what) {
  if (guests.empty() || !guest.is_set() || is_one_of(guests, guest)) return "";
  return "'" + std::string(guest.view()) + "' " + std::string(what) + "; " + names_of(guests);
}

}  // namespace

// A link takes the voices of the house's guests to the others, and no more.
std::string trouble_of_speaking(const HouseConfig& session, const GuestId& guest) {
  return trouble_of(session.guests, guest,
                    "is no guest of this house, so nobody would hear what is said");
}

std::string trouble_of_feeling(const HouseConfig& session, const GuestId& guest) {
  return trouble_of(dancers_of(session), guest,
                    "does not dance in this house, and would feel nothing");
}

void replace_guests(HouseConfig& session, std::vector<GuestId> guests) {
  session.guests = std::move(guests);
  if (session.voice && !session.voice->names_guest && !session.guests.empty())
    session.voice->guest = session.guests.front();
}

Result<void> set_shown_name(HouseConfig& session, std::string_view text) {
  const std::size_t equals = text.find('=');
  const auto named = equals == std::string_view::npos ? std::optional<GuestId>()
                                                      : GuestId::parse(text.substr(0, equals));
  if (session.guests.empty()) return fail("'" + plain_text(text) + "': no guest dances here");
  const GuestId guest = named.value_or(session.guests.front());
  if (!is_one_of(session.guests, guest))
    return fail(trouble_of(session.guests, guest, "is no guest of this house"));
  const std::string_view name = named ? text.substr(equals + 1) : text;
  const auto shown = parse_shown_name(name);
  if (!shown) return fail("'" + plain_text(name) + "': " + kShownNameRule);
  session.shown_names[guest] = *shown;
  return {};
}

void only_watch(HouseConfig& session) {
  session.watch = true;
  session.producers.clear();
  session.receivers.clear();
  session.cameras.clear();
  session.headsets.clear();
  session.haptics.clear();
  session.avatars.clear();
  session.styles.clear();
  session.voice.reset();
}

Result<void> check_guests(const HouseConfig& session) {
  constexpr const char* kCure = "; name this guest with --guest as well, or change the file";
  if (session.voice) {
    const std::string trouble = trouble_of_speaking(session, session.voice->guest);
    if (!trouble.empty()) return fail("[voice] guest " + trouble + kCure);
  }
  for (const HostedHaptics& haptics : session.haptics) {
    const std::string trouble = trouble_of_feeling(session, haptics.guest);
    if (!trouble.empty()) return fail("[[haptics]] guest " + trouble + kCure);
  }
  return {};
}

}  // namespace dance
