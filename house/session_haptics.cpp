#include "house/session_haptics.h"

namespace dance {

void read_haptics(TomlReader& reader, HouseConfig& session) {
  HostedHaptics haptics;
  haptics.to = reader.required_string("to");
  haptics.guest = read_guest(reader, "guest", reader.required_string("guest"));
  HapticOptions& options = haptics.options;
  options.device = reader.string_or("device", "");
  options.address = reader.string_or("address", "");
  options.player.strength = static_cast<float>(reader.number_or("strength", 1.0, 0.0, 2.0));
  options.player.limit = static_cast<float>(reader.number_or("limit", 1.0, 0.0, 1.0));
  options.player.latency =
      Duration::seconds(1e-3 * reader.number_or("latency_ms", 0.0, 0.0, 400.0));
  options.player.is_on = reader.bool_or("on", true);
  if (reader.has("feel")) {
    const auto felt = parse_felt(reader.strings("feel", "[\"touch\", \"lead\", \"one\"]"));
    if (felt)
      options.maker = *felt;
    else
      reader.complain("feel", felt.error().what);
  }
  if (const auto checked = check_haptic_options(haptics.to, options); !checked)
    reader.complain("to", checked.error().what);
  reader.finish();
  session.haptics.push_back(haptics);
}

}  // namespace dance
