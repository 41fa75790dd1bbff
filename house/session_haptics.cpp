#include "house/session_haptics.h"

#include <fmt/format.h>

#include "house/session_guests.h"

namespace dance {
namespace {

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
  if (const std::string trouble = trouble_of_feeling(session, haptics.guest); !trouble.empty())
    reader.complain("guest", trouble);
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
