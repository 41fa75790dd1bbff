// How devices that run for a guest are told things from another terminal: off, on, no stronger
// than. Several programs may serve one guest on a bus, as a house and a `dance haptics` beside it:
// all are told.
//
// Units/frames: limit 0 to 1.
// Ownership:    HapticControl owns its socket file; feeds and poller must outlive it.
// Threads:      the poller's.
// Failure:      what is no command is counted and nothing else; open() and tell_haptics() say why
//               nothing can be told.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/net/program_control.h"
#include "haptics/haptic_feed.h"

namespace dance {

struct HapticCommand {
  enum class Kind : std::uint8_t { kOn, kOff, kLimit };
  Kind kind = Kind::kOff;
  float limit = 1.0f;
};

// "on", "off", "limit 0.4".
std::optional<HapticCommand> parse_haptic_command(std::string_view text);
std::string text_of(const HapticCommand& command);

class HapticControl {
 public:
  // `bus` as the program was given it; the feeds are of one guest. `told` is called after each
  // command, with a line for people.
  using OnTold = std::function<void(const std::string& line)>;
  static Result<std::unique_ptr<HapticControl>> open(const std::string& bus,
                                                     std::vector<HapticFeed*> feeds, OnTold told,
                                                     Poller& poller);
  std::uint64_t refused() const { return refused_; }

 private:
  HapticControl(std::vector<HapticFeed*> feeds, OnTold told)
      : feeds_(std::move(feeds)), told_(std::move(told)) {}
  void hear(std::string_view text);

  std::vector<HapticFeed*> feeds_;
  OnTold told_;
  std::uint64_t refused_ = 0;
  std::unique_ptr<ProgramControl> control_;
};

// How many programs were told; fails where there is none.
Result<int> tell_haptics(const std::string& bus, const GuestId& guest,
                         const HapticCommand& command);

}  // namespace dance
