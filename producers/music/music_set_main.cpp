// dance music set: controls a running dance music.

#include <vector>

#include "core/base/plain_number.h"
#include "core/program/program.h"
#include "producers/music/band/band_song.h"
#include "producers/music/control/music_control.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  dance music set --volume 0.4        softer, at once, in this house alone
  dance music set --volume 0          the beat goes on, and nothing is heard
  dance music set slower              the house band, in all houses of the room, from a bar on
  dance music set --style bachata     the band's next song, at once
  dance music set --speed 0.8         a file, in a house that is in no room: 0.5 to 1.1
Commands of the house band: next, pause, play, slower, faster, and for a host lock and unlock: while
the song is locked, only hosts may change it. A house in no room plays a file by the same commands,
without the lock: next is the next file of its folder. Volume and style from the next start on are
in the house file: volume and band in [music].
)";

dance::Result<void> control(const std::string& bus, const std::string& text, double volume,
                            const std::string& style, double speed) {
  using What = dance::MusicCommand::What;
  std::vector<dance::MusicCommand> commands;
  if (!text.empty()) {
    const auto command = dance::parse_music_command(text);
    if (!command)
      return dance::fail("'" + text +
                         "' is no command: next, pause, play, slower, faster, lock, unlock");
    commands.push_back(*command);
  }
  if (!style.empty()) {
    const auto command = dance::parse_music_command("style " + style);
    if (!command || !dance::band_style_of(style))
      return dance::fail("--style '" + style + "': the band plays " + dance::band_style_names());
    commands.push_back(*command);
  }
  if (volume >= 0.0) commands.push_back({.what = What::kVolume, .volume = volume});
  if (speed > 0.0) {
    const auto command = dance::parse_music_command("speed " + dance::plain_number(speed));
    if (!command) return dance::fail("--speed takes 0.5 to 1.1, 1 = as in the file");
    commands.push_back(*command);
  }
  if (commands.empty())
    return dance::fail(
        "nothing to change: give --volume, --speed, --style or a command such as next");
  for (const dance::MusicCommand& command : commands)
    if (auto sent = dance::send_music_command(bus, command); !sent) return sent;
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  std::string bus, command, style;
  double volume = -1.0, speed = 0.0;
  dance::CommandLine line("Controls a dance music that runs.", "dance music set");
  line.add("COMMAND", command,
           "of the house band: next, pause, play, slower, faster, lock, unlock");
  line.add("--bus", bus, "LCM URL of the house's bus");
  line.add("--volume", volume, "0 to 1, 1 = as in the file").range(0.0, 1.0);
  line.add("--speed", speed, "of a file, 1 = as recorded; 0 = unchanged").range(0.0, 1.1);
  line.add("--style", style, "of the house band: salsa, bachata, tango and so on");
  line.footer(kExamples);
  return dance::run_program(line, argc, argv,
                            [&] { return control(bus, command, volume, style, speed); });
}
