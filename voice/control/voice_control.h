// How a running `dance voice` is told things from another terminal, a foot switch's script or a
// viewer: one line of text in a datagram, within this user.
//
// Units/frames: lines as VoiceSettings::apply() takes them, of kMostBytes at most.
// Ownership:    VoiceControl owns its socket file; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() fails where another program speaks for the same guest on the same bus;
//               tell_voice() says when none does.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/guest_id.h"
#include "core/net/local_datagram.h"
#include "core/net/poller.h"

namespace dance {

class VoiceControl {
 public:
  static constexpr std::size_t kMostBytes = 64;
  using OnCommand = std::function<void(std::string_view command, MonoTime now)>;

  static Result<std::unique_ptr<VoiceControl>> open(const std::string& bus, const GuestId& guest,
                                                    OnCommand on_command, Poller& poller);
  ~VoiceControl();
  VoiceControl(const VoiceControl&) = delete;
  VoiceControl& operator=(const VoiceControl&) = delete;

 private:
  VoiceControl(std::unique_ptr<LocalDatagramSocket> socket, OnCommand on_command, Poller& poller);

  std::unique_ptr<LocalDatagramSocket> socket_;
  OnCommand on_command_;
  Poller& poller_;
};

// `bus` as the program was given it.
std::string voice_control_path(const std::string& bus, const GuestId& guest);
Result<void> tell_voice(const std::string& bus, const GuestId& guest, std::string_view command);

}  // namespace dance
