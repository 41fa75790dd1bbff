// Unpredictable numbers from the kernel: session ids, link tokens.
//
// Threads: any.
// Failure: none; the kernel's generator is always ready on the systems we run on.
#pragma once

#include <cstdint>

namespace dance {

std::uint64_t secure_random_u64();

}  // namespace dance
