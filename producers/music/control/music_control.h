// The control channel of a running `dance music`: another terminal or a viewer sets its volume, and
// chooses what the house band plays. Where two play on one bus, both receive each command.
//
// Units/frames: volumes are factors, 0 = silent, 1 = as in the file; so are speeds.
// Ownership:    MusicControl owns its socket file; the poller must outlive it.
// Threads:      the poller's; the functions are for any.
// Failure:      a line that is no command changes nothing; open() and send_music_command() name why
//               no command can be received or sent.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/fixed_string.h"
#include "core/net/program_control.h"

namespace dance {

// The house band has no speed, but tempi. Songs of files have no style and no lock.
struct MusicCommand {
  enum class What : std::uint8_t {
    kVolume,
    kNext,
    kPlay,
    kPause,
    kSlower,
    kFaster,
    kLock,
    kUnlock,
    kStyle,
    kSpeed
  };
  What what = What::kVolume;
  double volume = 1.0;
  double speed = 1.0;  // within music_speed.h
  FixedString<15> style{};
};

class MusicControl {
 public:
  using OnCommand = std::function<void(const MusicCommand& command)>;
  // `bus` as the program was given it.
  static Result<std::unique_ptr<MusicControl>> open(const std::string& bus, OnCommand on_command,
                                                    Poller& poller);

 private:
  explicit MusicControl(std::unique_ptr<ProgramControl> control) : control_(std::move(control)) {}
  std::unique_ptr<ProgramControl> control_;
};

// "volume 0.4", "speed 0.8", "next", "style bachata"; nothing for another line.
std::optional<MusicCommand> parse_music_command(std::string_view line);
std::string text_of(const MusicCommand& command);
// A program of this user plays music on this bus.
bool is_music_played(const std::string& bus);
Result<void> send_music_command(const std::string& bus, const MusicCommand& command);

}  // namespace dance
