// How a running `dance voice` is told things from another terminal, a foot switch's script or a
// viewer: the socket of a guest's voice on a bus.
//
// Units/frames: lines as VoiceSettings::apply() takes them, of kMostBytes at most.
// Ownership:    VoiceControl owns its socket file; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() fails where another program speaks for the same guest on the same bus;
//               send_voice_command() says when none does.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/net/program_control.h"

namespace dance {

class VoiceControl {
 public:
  static constexpr std::size_t kMostBytes = ProgramControl::kMostBytes;
  using OnCommand = ProgramControl::OnCommand;

  static Result<std::unique_ptr<VoiceControl>> open(const std::string& bus, const GuestId& guest,
                                                    OnCommand on_command, Poller& poller);

 private:
  explicit VoiceControl(std::unique_ptr<ProgramControl> control) : control_(std::move(control)) {}
  std::unique_ptr<ProgramControl> control_;
};

// `bus` as the program was given it.
std::string voice_control_path(const std::string& bus, const GuestId& guest);
Result<void> send_voice_command(const std::string& bus, const GuestId& guest,
                                std::string_view command);

}  // namespace dance
