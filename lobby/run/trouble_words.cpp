#include "lobby/run/trouble_words.h"

#include <array>

namespace dance {
namespace {

enum class Names { kNothing, kServer, kGuest, kCamera };

struct Sign {
  std::string_view says;
  Text text;
  Names names;
  bool is_fatal;
};

// As the programs write them: tunnel/link/link_text.cpp, tunnel/link/link_key.cpp, house/,
// producers/camera/, core/sound/. The test of lobby/ takes the lines from there.
constexpr std::array kSigns{
    Sign{"does not know this house's key", Text::kLobbyKeyRefused, Names::kServer, true},
    Sign{"has another key than", Text::kLobbyServerKeyChanged, Names::kServer, true},
    Sign{"this house's key has expired", Text::kLobbyKeyExpired, Names::kServer, true},
    Sign{"key is in use in as many places", Text::kLobbyKeyBusy, Names::kServer, true},
    Sign{"key has opened as many rooms", Text::kLobbyKeyBusy, Names::kServer, true},
    Sign{"key has as many places in room", Text::kLobbyKeyBusy, Names::kServer, true},
    Sign{"there is no key for", Text::kLobbyNoKey, Names::kServer, true},
    Sign{"already through another link", Text::kLobbyNameTaken, Names::kGuest, true},
    Sign{"is full: wait", Text::kLobbyRoomFull, Names::kNothing, true},
    Sign{"as many listeners", Text::kLobbyRoomFull, Names::kNothing, true},
    Sign{"no place for another link", Text::kLobbyRoomFull, Names::kNothing, true},
    Sign{"a host has removed this house", Text::kLobbyRemoved, Names::kNothing, true},
    Sign{"key does not open room", Text::kLobbyNotForYou, Names::kNothing, true},
    Sign{"key does not allow a guest", Text::kLobbyNotForYou, Names::kNothing, true},
    Sign{"key only listens", Text::kLobbyNotForYou, Names::kNothing, true},
    Sign{"does not take a name", Text::kLobbyNotForYou, Names::kNothing, true},
    Sign{"this house cannot agree", Text::kLobbyVersions, Names::kNothing, true},
    Sign{"a pose codec that this link does not", Text::kLobbyVersions, Names::kNothing, true},
    Sign{"of the wire format", Text::kLobbyVersions, Names::kNothing, true},
    // A link tries the server's next address, and then again.
    Sign{"does not answer: is `dance server`", Text::kLobbyServerSilent, Names::kServer, false},
    Sign{"answers, and then no more", Text::kLobbyServerSilent, Names::kServer, false},
    Sign{"cannot be resolved", Text::kLobbyServerSilent, Names::kServer, true},
    Sign{"in use; close the program", Text::kLobbyCameraTaken, Names::kCamera, false},
    Sign{"in use by another program", Text::kLobbyCameraTaken, Names::kCamera, false},
    Sign{"dance voice: no sound server", Text::kLobbyMicrophoneUnreachable, Names::kNothing, false},
    Sign{"no microphone", Text::kLobbyMicrophoneSilent, Names::kNothing, false},
    Sign{"nobody dances in this recording", Text::kLobbyFileUnreadable, Names::kNothing, true},
    Sign{"none in it is called", Text::kLobbyFileUnreadable, Names::kNothing, true},
};

std::vector<std::string> names_for(Names names, const LobbySettings& settings) {
  switch (names) {
    case Names::kServer:
      return {settings.server};
    case Names::kGuest:
      return {settings.name};
    case Names::kCamera:
      return {settings.camera};
    case Names::kNothing:
      break;
  }
  return {};
}

}  // namespace

std::optional<ChildTrouble> trouble_in(std::string_view line, const LobbySettings& settings) {
  for (const Sign& sign : kSigns)
    if (line.find(sign.says) != std::string_view::npos)
      return ChildTrouble{
          error_banner(sign.text, names_for(sign.names, settings), std::string(line)),
          sign.is_fatal};
  return std::nullopt;
}

namespace {

LobbyBanner newest_trouble(const std::deque<std::string>& lines, const LobbySettings& settings,
                           Text otherwise, bool is_fatal) {
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    if (auto trouble = trouble_in(*line, settings); trouble && (trouble->is_fatal || !is_fatal))
      return trouble->banner;
  return error_banner(otherwise, {}, lines.empty() ? "" : lines.back());
}

}  // namespace

bool says_it_is_in(std::string_view line, bool is_alone) {
  return is_alone ? line.starts_with("the house is open") : line.starts_with("in room '");
}

LobbyBanner start_error_of(const std::deque<std::string>& lines, const LobbySettings& settings) {
  return newest_trouble(lines, settings, Text::kLobbyNotBegun, false);
}

LobbyBanner end_error_of(const std::deque<std::string>& lines, const LobbySettings& settings) {
  return newest_trouble(lines, settings, Text::kLobbyDanceEnded, true);
}

}  // namespace dance
