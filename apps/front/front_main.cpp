// dance: the front end of all programs. `dance demo` runs dance-demo, as git does; words that are
// not a command are looked up with the next one, so that `dance bench path` runs dance-bench-path.

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/program/program.h"

namespace {

struct Command {
  std::string_view name;  // as typed
  std::string_view summary;
};

constexpr std::array kCommands{
    Command{"lobby", "the window for dancers: you, with whom, a room of your own"},
    Command{"demo",
            "two houses, a server between them, dancers, a stage: the main job on one machine"},
    Command{"join", "all of a house in one, from one session file"},
    Command{"view", "the viewer"},
    Command{"replay", "plays recorded dances (.bvh .glb .lcm .mcap .csv) as dancers"},
    Command{"salsa", "a synthetic salsa dancer, for machines with no camera and no data"},
    Command{"capture", "a dancer before a camera, or in a video"},
    Command{"fetch-models", "fetches the networks that capture sees a dancer with"},
    Command{"music", "plays music, and says the beat that is heard"},
    Command{"voice", "speak with the others, and hear them where their dancers stand"},
    Command{"server", "the tunnel server"},
    Command{"status", "rooms and guests of a server on this machine, in a terminal"},
    Command{"key", "keeps the keys that servers gave to this house"},
    Command{"link", "a house's link to the server"},
    Command{"manager", "the signal manager of a house"},
    Command{"listen", "passes dancers on: text, files, engines, avatar apps"},
    Command{"receive", "a dancer from another program or a device"},
    Command{"headset", "dances with a headset, and shows the stage in it"},
    Command{"haptics", "what a dancer feels: touches, the beat, the lead's hand, on devices"},
    Command{"record", "records the bus to an LCM log, packed or plain"},
    Command{"pack", "makes an LCM log smaller, and loses nothing"},
    Command{"unpack", "makes a plain LCM log of a packed one"},
    Command{"convert", "between recordings: .lcm, .bvh, .glb, .mcap (Foxglove), .csv"},
    Command{"avatar", "chooses, lists, makes avatars, and says what is in an avatar's file"},
    Command{"chat", "a line, applause or a heart for everybody in the room"},
    Command{"style", "says how large a guest's dance is shown: hips=1.5, preset=cuban"},
    Command{"latency", "the table of a pose's journey, with numbers"},
    Command{"top", "channels and programs of the bus, in a terminal"},
    Command{"spy", "lcm-spy with our types"},
    Command{"doctor", "checks this machine, and names what mends it"},
    Command{"crowd", "simulated guests in rooms of a server: a load generator"},
    Command{"lossy", "a bad line between two programs: delay, jitter, loss"},
    Command{"capture solve eval",
            "the camera's solver on recorded dances: errors, feet, bones, lag"},
    Command{"capture couple eval", "two dancers before one camera: identities, hands in hold"},
    Command{"music eval", "the beat tracker on songs whose beats are known"},
    Command{"band eval", "the house band: beats that trackers find, loudness, cost"},
    Command{"music make", "makes songs whose beats are known, to train with"},
    Command{"music train", "trains a model of the beat tracker"},
    Command{"capture eval", "what the camera's eye sees in pictures and videos, frame by frame"},
    Command{"codec eval", "the pose codec on recorded dances: bytes, errors, times, losses"},
    Command{"codec train", "trains a model of the pose codec"},
    Command{"stylize eval", "what styles do to recorded dances: gain, mean pose, bones, feet"},
    Command{"stage eval",
            "a recorded couple on avatars: do hands meet, do feet stand, at what cost"},
    Command{"touch eval", "held hands of recorded couples: recognised, and brought together?"},
    Command{"rhythm eval",
            "remote dancers on the beat that the listener hears, on recorded dances"},
    Command{"rhythm film", "a recorded couple over a line, shown in several ways side by side"},
    Command{"predict eval",
            "prediction on recorded dances: errors beside simple extrapolators, cost"},
    Command{"display eval", "extrapolation to the photon on recorded dances, beside holding"},
    Command{"predict train", "trains a model of prediction"},
    Command{"trackers eval", "whole bodies from few tracked points, on recorded dances"},
    Command{"trackers train", "trains a model of whole bodies from few tracked points"},
    Command{"capture stereo eval",
            "depth from two cameras, on drawn dancers whose distance is known"},
    Command{"capture several eval",
            "two webcams without a board, on recorded dances before simulated cameras"},
    Command{"capture several drawn", "two webcams that are drawn, before the real pose network"},
    Command{"lapse eval", "dances whose poses stop for a while: what is shown meanwhile"},
    Command{"predict stream",
            "dances over a line with delay, jitter and loss: how late, how smooth"},
    Command{"haptics set", "tells the haptics of a guest: off, on, how strong at most"},
    Command{"music set", "controls a dance music that runs: volume, song, tempo"},
    Command{"voice set", "tells a dance voice that runs: mute, talk, volumes"},
    Command{"bench path", "a pose's journey against the same number of bare hops"},
    Command{"bench tunnel", "a crowd through the server, beside bare UDP and ENet relays"},
    Command{"bench voice", "voices: codec, play-out over lines, echo, mouth to ear"},
    Command{"bench avatar", "an avatar's file through the tunnel, and the poses beside it"},
    Command{"bench flood", "a couple through a server that is flooded with hostile datagrams"},
    Command{"bench line", "two dancers over recorded lines: ages, freezes, recovery"},
    Command{"bench hold", "play-out buffers over recorded lines: delay against freezes"},
    Command{"bench adapter", "what an engine pays to read a stage, and how old the dancers are"},
    Command{"bench view", "what a picture of a full stage costs, beside the empty one"},
    Command{"bench display", "capture to swap: poses taken late, or at frame start"},
    Command{"bench replay", "opening and jumping in a long recorded night"},
    Command{"bench headset", "from a headset's sensors to the link"},
    Command{"bench parts", "what each part of the pose path costs, against a baseline"},
};

std::string with_dashes(std::string_view name) {
  std::string words(name);
  for (char& c : words)
    if (c == ' ') c = '-';
  return words;
}

std::string program_of(std::string_view name) {
  return dance::program_folder() + "/dance-" + with_dashes(name);
}

// Those that ./dance builds when they are called: cmake/DanceTargets.cmake writes the list beside a
// build, an installation has none.
std::set<std::string> buildable_commands() {
  std::set<std::string> commands;
  std::ifstream list(dance::data_folder() + "/commands.txt");
  for (std::string line; std::getline(list, line);) commands.insert(line.substr(0, line.find(' ')));
  return commands;
}

// Those that were built or installed, or that ./dance builds.
void print_commands(std::FILE* out) {
  std::fputs("usage: dance COMMAND [OPTIONS]   (dance COMMAND --help tells more)\n\n", out);
  const std::set<std::string> buildable = buildable_commands();
  bool is_for_dancers = true;  // of one word
  for (const Command& command : kCommands) {
    if (access(program_of(command.name).c_str(), X_OK) != 0 &&
        !buildable.contains(with_dashes(command.name)))
      continue;
    const bool is_measure = command.name.find(' ') != std::string_view::npos;
    if (is_for_dancers && is_measure) std::fputs("\nMeasuring and training:\n", out);
    is_for_dancers = !is_measure;
    std::fprintf(out, "  %-*.*s %.*s\n", is_measure ? 21 : 12,
                 static_cast<int>(command.name.size()), command.name.data(),
                 static_cast<int>(command.summary.size()), command.summary.data());
  }
  std::fputs(
      "\nFirst steps:\n  dance doctor\n  dance demo\n  dance            (on a desktop: the "
      "window)\n",
      out);
}

// The command that is meant, and how many words it takes: the most that make one.
const Command* find_command(const std::vector<char*>& words, std::size_t& taken) {
  std::string name;
  const Command* found = nullptr;
  for (std::size_t i = 0; i < words.size() && i < 3; ++i) {
    name += (i > 0 ? " " : "") + std::string(words[i]);
    for (const Command& command : kCommands) {
      if (command.name != name) continue;
      found = &command;
      taken = i + 1;
    }
  }
  return found;
}

// What to say to a word that is none, or only the first of several.
std::string no_command_line(const std::string& word) {
  std::string longer;
  for (const Command& command : kCommands)
    if (command.name.substr(0, word.size() + 1) == word + " ")
      longer += (longer.empty() ? "" : ", ") + ("dance " + std::string(command.name));
  if (!longer.empty()) return "'" + word + "' needs another word: " + longer;
  return "there is no command '" + word + "'; `dance help` lists them";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    // On a desktop the window; without a display, or built without one, the list.
    std::string lobby = program_of("lobby");
    if (!dance::display_name().empty() && access(lobby.c_str(), X_OK) == 0) {
      const std::array<char*, 2> alone{lobby.data(), nullptr};
      execv(lobby.c_str(), alone.data());
    }
    print_commands(stdout);
    return 0;
  }
  const std::string_view first = argv[1];
  if (first == "--version" && argc == 2) {
    std::puts("DanceGraph " DANCE_VERSION);
    return 0;
  }
  const bool is_help = first == "--help" || first == "-h" || first == "help";
  if (is_help && argc == 2) {
    print_commands(stdout);
    return 0;
  }
  const std::vector<char*> words(argv + (is_help ? 2 : 1), argv + argc);
  std::size_t taken = 0;
  const Command* command = find_command(words, taken);
  if (!command) {
    std::fprintf(stderr, "dance: %s\n", no_command_line(words[0]).c_str());
    return 2;
  }
  const std::string path = program_of(command->name);
  std::string name = path.substr(path.rfind('/') + 1);
  std::vector<char*> arguments{name.data()};
  std::string help = "--help";
  if (is_help) arguments.push_back(help.data());
  arguments.insert(arguments.end(), words.begin() + static_cast<std::ptrdiff_t>(taken),
                   words.end());
  arguments.push_back(nullptr);
  execv(path.c_str(), arguments.data());
  std::fprintf(
      stderr,
      "dance: %s cannot be run: %s; it was not built, or not installed: in the source tree "
      "./dance builds it when it is called; build/release.configure.log lists the features\n",
      path.c_str(), std::strerror(errno));  // NOLINT(concurrency-mt-unsafe): one thread
  return 1;
}
