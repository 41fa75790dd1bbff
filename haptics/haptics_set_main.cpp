// dance haptics set: tells the haptics of a guest that run something.

#include "core/program/program.h"
#include "haptics/haptic_control.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance haptics set --guest alice --off             nothing is felt any more, at once
  dance haptics set --guest alice --on
  dance haptics set --guest alice --limit 0.4       no stronger than that, 1 = all a device has
All devices of the guest on this bus are told: those of a house ([[haptics]]) and of dance haptics.
)";

struct HapticsSetOptions {
  std::string guest, bus;
  bool on = false, off = false;
  double limit = -1.0;
};

Result<void> set_haptics(const HapticsSetOptions& options) {
  using Kind = HapticCommand::Kind;
  const GuestId guest = *GuestId::parse(options.guest);
  const auto tell = [&](const HapticCommand& command) -> Result<void> {
    DANCE_TRY([[maybe_unused]] const int told, tell_haptics(options.bus, guest, command));
    return {};
  };
  // Weaker before it is on.
  if (options.limit >= 0.0)
    if (auto told = tell({Kind::kLimit, static_cast<float>(options.limit)}); !told) return told;
  if (options.on) return tell({Kind::kOn, 1.0f});
  if (options.off) return tell({Kind::kOff, 1.0f});
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::HapticsSetOptions options;
  dance::CommandLine line("Tells what lets a guest feel: off, on, how strong at most.",
                          "dance haptics set");
  line.add("--guest", options.guest, "whose haptics").guest_name().required();
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add_flag("--off", options.off, "nothing is felt any more");
  line.add_flag("--on", options.on, "felt again");
  line.add("--limit", options.limit, "nothing is felt more strongly, 1 = all the device has")
      .range(0.0, 1.0);
  line.footer(dance::kExamples);
  line.finally([&]() -> dance::Result<void> {
    if (options.on && options.off) return dance::fail("--on and --off exclude each other");
    if (!options.on && !options.off && options.limit < 0.0)
      return dance::fail("nothing is to be set: --off, --on or --limit");
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::set_haptics(options); });
}
