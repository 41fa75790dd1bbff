// dance music set: tells a running dance music how loud to play.

#include "core/program/program.h"
#include "producers/music/control/music_control.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  dance music set --volume 0.4        softer, at once, in this house alone
  dance music set --volume 0          the beat goes on, and nothing is heard
What is to be so from the next start on stands in the session file: volume in [music].
)";

}  // namespace

int main(int argc, char** argv) {
  std::string bus;
  double volume = -1.0;
  dance::CommandLine line("Tells a dance music that runs how loud to play.", "dance music set");
  line.add("--bus", bus, "LCM URL of the house's bus");
  line.add("--volume", volume, "0 to 1, 1 = as in the file").range(0.0, 1.0).required();
  line.footer(kExamples);
  return dance::run_program(line, argc, argv,
                            [&] { return dance::tell_music_volume(bus, volume); });
}
