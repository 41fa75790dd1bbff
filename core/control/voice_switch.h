// The switch of a guest's voice: a window of this user turns the house's `dance voice` of that
// guest on or off during the dance.
//
// Ownership: the switch owns its socket file; the poller must outlive it.
// Threads:   the poller's; the free functions may be called from any thread.
// Failure:   a line that is neither "on" nor "off" changes nothing. open_voice_switch() and
//            send_voice_switch() name why no request can be received or sent.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/net/program_control.h"

namespace dance {

// `bus` is an LCM URL, "" = the usual one.
Result<std::unique_ptr<ProgramControl>> open_voice_switch(const std::string& bus,
                                                          const GuestId& guest,
                                                          std::function<void(bool)> on_switch,
                                                          Poller& poller);
// A house of this user can turn the voice of this guest on and off.
bool has_voice_switch(const std::string& bus, const GuestId& guest);
Result<void> send_voice_switch(const std::string& bus, const GuestId& guest, bool is_on);

}  // namespace dance
