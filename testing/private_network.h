// A network namespace of this process's own, with multicast on its loopback device: nothing sent in
// it can leave the machine or meet another house's bus. For the demo, benchmarks and tests on
// machines whose loopback has no multicast route; needs root or a kernel that lets users make
// namespaces (Debian's does).
//
// Ownership: children inherit the namespace; it ends with its last process.
// Threads:   call while the process has one thread.
// Failure:   names what the kernel refused.
#pragma once

#include "core/base/result.h"

namespace dance {

Result<void> enter_private_network();

}  // namespace dance
