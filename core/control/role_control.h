// The role of a synthetic dancer, changed while it dances: by a viewer, or by any program of this
// user.
//
// Ownership: the control owns its socket file; the poller must outlive it.
// Threads:   the poller's; the free functions may be called from any thread.
// Failure:   a line that names no role changes nothing. open_role_control() and send_role() name
//            why no role can be received or sent.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/net/program_control.h"

namespace dance {

enum class DanceRole : std::uint8_t {
  kEither,  // leads, or follows a dancer who leads already
  kLead,
  kFollow
};
// "any", "lead", "follow", as in the house file.
std::string_view name_of(DanceRole role);
std::optional<DanceRole> dance_role_of(std::string_view name);

// `bus` is an LCM URL, "" = the usual one.
Result<std::unique_ptr<ProgramControl>> open_role_control(const std::string& bus,
                                                          const GuestId& guest,
                                                          std::function<void(DanceRole)> on_role,
                                                          Poller& poller);
// This guest is a synthetic dancer of a house of this user.
bool has_role_control(const std::string& bus, const GuestId& guest);
Result<void> send_role(const std::string& bus, const GuestId& guest, DanceRole role);

}  // namespace dance
