// How a running `dance music` is told from another terminal or a viewer how loud to play. Where two
// play on one bus, both are told.
//
// Units/frames: volumes are factors, 0 = silent, 1 = as in the file.
// Ownership:    MusicControl owns its socket file; the poller must outlive it.
// Threads:      the poller's; the functions are for any.
// Failure:      what is no command changes nothing; open() and tell_music_volume() say why nothing
//               can be told.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/net/program_control.h"

namespace dance {

class MusicControl {
 public:
  using OnVolume = std::function<void(double volume)>;
  // `bus` as the program was given it.
  static Result<std::unique_ptr<MusicControl>> open(const std::string& bus, OnVolume on_volume,
                                                    Poller& poller);

 private:
  explicit MusicControl(std::unique_ptr<ProgramControl> control) : control_(std::move(control)) {}
  std::unique_ptr<ProgramControl> control_;
};

// "volume 0.4"; nothing where it is no such line.
std::optional<double> parse_music_volume(std::string_view command);
// Whether a program of this user plays music on this bus.
bool is_music_played(const std::string& bus);
Result<void> tell_music_volume(const std::string& bus, double volume);

}  // namespace dance
