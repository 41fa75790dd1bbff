// Why a socket could not be bound to an address, with the cure: one line.
//
// Threads: any.
#pragma once

#include <string>

#include "core/net/address.h"

namespace dance {

std::string bind_error(const Address& local, int error);

}  // namespace dance
