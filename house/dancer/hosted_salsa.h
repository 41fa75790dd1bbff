// A house's synthetic salsa dancers: made from the house file, and their role changed while they
// dance.
//
// Ownership: a control refers to the dancer and the poller, which must outlive it.
// Threads:   the poller's.
// Failure:   make_salsa() names the value that is out of range.
#pragma once

#include <memory>

#include "core/control/role_control.h"
#include "house/dancer/placed_salsa.h"
#include "house/session_producers.h"

namespace dance {

// The dancer is in step with those of other houses, and dances to `music` while there is some.
Result<std::unique_ptr<PlacedSalsa>> make_salsa(const HostedProducer& producer,
                                                const BeatClock& music, MonoTime start);
// Null, with a warning, if its socket cannot be opened.
std::unique_ptr<ProgramControl> open_role_control_of(PlacedSalsa& salsa, const GuestId& guest,
                                                     const std::string& bus, Poller& poller);

}  // namespace dance
