#include "house/session_haptics.h"

#include <fmt/format.h>

#include <algorithm>

namespace dance {
namespace {

// Whom the house has on its stage of its own.
std::vector<GuestId> dancers_of(const HouseConfig& session) {
  std::vector<GuestId> dancers = session.guests;
  const auto add = [&](const GuestId& guest) {
    if (guest.is_set() && std::find(dancers.begin(), dancers.end(), guest) == dancers.end())
      dancers.push_back(guest);
  };
  for (const HostedProducer& producer : session.producers) add(producer.guest);
  for (const HostedReceiver& receiver : session.receivers) add(receiver.options.guest);
  for (const HostedCamera& camera : session.cameras) add(camera.guest);
  for (const Route& route : session.routes)
    if (route.from.where == Where::kCapture) add(route.to.guest);
  return dancers;
}

// A house that names no dancer may have one whose producer runs beside it.
void check_is_here(TomlReader& reader, const HouseConfig& session, const GuestId& guest) {
  const std::vector<GuestId> dancers = dancers_of(session);
  if (dancers.empty() || !guest.is_set()) return;
  if (std::find(dancers.begin(), dancers.end(), guest) != dancers.end()) return;
  std::string names;
  for (const GuestId& each : dancers)
    names += (names.empty() ? "" : ", ") + std::string(each.view());
  reader.complain(
      "guest", "'" + std::string(guest.view()) +
                   "' does not dance in this house, and would feel nothing; there are: " + names);
}

std::vector<std::string> felt_words(const HapticMakerOptions& felt) {
  std::vector<std::string> words;
  if (felt.touch) words.emplace_back("touch");
  if (felt.lead) words.emplace_back("lead");
  if (felt.beats == FeltBeats::kOne) words.emplace_back("one");
  if (felt.beats == FeltBeats::kAll) words.emplace_back("beats");
  return words;
}

}  // namespace

void read_haptics(TomlReader& reader, HouseConfig& session) {
  HostedHaptics haptics;
  haptics.to = reader.required_string("to");
  haptics.guest = read_guest(reader, "guest", reader.required_string("guest"));
  check_is_here(reader, session, haptics.guest);
  HapticOptions& options = haptics.options;
  options.device = reader.string_or("device", "");
  options.address = reader.string_or("address", "");
  options.player.strength = static_cast<float>(reader.number_or("strength", 1.0, 0.0, 2.0));
  options.player.limit = static_cast<float>(reader.number_or("limit", 1.0, 0.0, 1.0));
  options.player.latency =
      Duration::seconds(1e-3 * reader.number_or("latency_ms", 0.0, 0.0, 400.0));
  options.player.is_on = reader.bool_or("on", true);
  haptics.realtime = reader.bool_or("realtime", false);
  if (reader.has("feel")) {
    const auto felt = parse_felt(reader.strings("feel", "[\"touch\", \"lead\", \"one\"]"));
    if (felt)
      options.maker = *felt;
    else
      reader.complain("feel", felt.error().what);
  }
  for (const std::string& name : reader.strings("from", "[\"bob\"]"))
    options.maker.from.push_back(read_guest(reader, "from", name));
  const auto bones = parse_bones(reader.strings("bones", "[\"leftHand\", \"leftLowerArm\"]"));
  if (bones)
    options.player.bones = *bones;
  else
    reader.complain("bones", bones.error().what);
  if (const auto checked = check_haptic_options(haptics.to, options); !checked)
    reader.complain("to", checked.error().what);
  reader.finish();
  session.haptics.push_back(haptics);
}

std::vector<std::string> haptics_arguments(const HostedHaptics& haptics, const std::string& bus) {
  const HapticOptions& options = haptics.options;
  std::vector<std::string> words{
      "--bus", bus, "--guest", std::string(haptics.guest.view()), "--realtime", "--quiet"};
  const auto add = [&](const char* option, const std::string& value) {
    words.push_back(std::string(option) + "=" + value);  // a value may begin with a dash
  };
  add("--to", haptics.to);
  if (!options.device.empty()) add("--device", options.device);
  if (!options.address.empty()) add("--address", options.address);
  add("--strength", fmt::format("{:.4f}", options.player.strength));
  add("--limit", fmt::format("{:.4f}", options.player.limit));
  add("--latency", fmt::format("{:.3f}", options.player.latency.as_ms()));
  if (!options.player.is_on) words.emplace_back("--off");
  for (const std::string& word : felt_words(options.maker)) add("--feel", word);
  for (const GuestId& guest : options.maker.from) add("--from", std::string(guest.view()));
  for (std::size_t bone = 0; options.player.bones != kAllBones && bone < kBoneCount; ++bone)
    if ((options.player.bones & (1u << bone)) != 0) add("--bones", std::string(kBones[bone].name));
  return words;
}

}  // namespace dance
