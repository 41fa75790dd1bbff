// dance voice set: tells a running dance voice something.

#include <array>

#include "core/program/program.h"
#include "voice/control/voice_control.h"
#include "voice/room/voice_settings.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance voice set --guest alice --mute              not heard any more
  dance voice set --guest alice --unmute
  dance voice set --guest alice --talk              heard for 0.7 s more, with push to talk: for a
                                                    foot switch that repeats it
  dance voice set --guest alice --volume bob=0.3
)";

struct VoiceSetOptions {
  std::string guest, bus;
  std::vector<std::string> volumes;
};

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::VoiceSetOptions options;
  dance::CommandLine line("Tells a dance voice that runs.", "dance voice set");
  line.add("--guest", options.guest, "whose dance voice").guest_name().required();
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  struct Flag {
    const char* command;
    const char* help;
    bool is_given = false;
  };
  std::array flags{Flag{"mute", "not heard", false},
                   Flag{"unmute", "heard again", false},
                   Flag{"deafen", "neither hears nor is heard", false},
                   Flag{"undeafen", "hears again", false},
                   Flag{"talk", "heard for 0.7 s more, with push to talk", false},
                   Flag{"stop-talking", "the end of --talk, at once", false},
                   Flag{"push-to-talk", "heard only while --talk comes", false},
                   Flag{"open", "heard without push to talk", false},
                   Flag{"with-picture", "voices as late as their dancers are shown", false},
                   Flag{"at-once", "voices as early as the line lets them", false}};
  for (Flag& flag : flags)
    line.add_flag("--" + std::string(flag.command), flag.is_given, flag.help);
  line.add("--volume", options.volumes, "GUEST=0 to GUEST=2, as bob=0.5; may be repeated")
      .one_each_time();
  line.footer(dance::kExamples);
  std::vector<std::string> commands;
  line.finally([&]() -> dance::Result<void> {
    dance::VoiceSettings checked;
    for (const Flag& flag : flags)
      if (flag.is_given) commands.emplace_back(flag.command);
    for (const std::string& volume : options.volumes) {
      if (auto set = checked.set_volume(volume); !set) return set;
      commands.push_back("volume " + volume);
    }
    if (commands.empty()) return dance::fail("nothing is to be set; --help lists what can be");
    return {};
  });
  return dance::run_program(line, argc, argv, [&]() -> dance::Result<void> {
    const auto guest = *dance::GuestId::parse(options.guest);
    for (const std::string& command : commands)
      if (auto told = dance::send_voice_command(options.bus, guest, command); !told) return told;
    return {};
  });
}
