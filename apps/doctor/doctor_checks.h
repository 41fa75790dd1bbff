// What the doctor looks at: each check is one finding, with the command that mends it.
//
// Ownership: plain values.
// Threads:   call from main.
// Failure:   a check that cannot look says so in its finding.
#pragma once

#include <string>
#include <vector>

#include "core/base/time.h"
#include "core/bus/bus_url.h"

namespace dance {

struct Finding {
  enum class Grade { kOk, kNote, kProblem };  // a problem = the main job cannot run
  std::string name;
  Grade grade = Grade::kOk;
  std::string what;
  std::string cure;  // a command; "" where none is needed
};

// Judges the device of the multicast route; "" means no route.
Finding check_multicast_device(const std::string& device);
// Reports which hosts of the network can reach the bus.
Finding check_bus_exposure(const BusAddress& address);
// Judges the kernel's limit of receive buffers.
Finding check_receive_buffer(long long rmem_max_bytes);
// From how much later than asked a sleeping process was woken, at the 99th percentile.
Finding check_wake_ups(Duration lateness_p99);

// Everything about this machine.
std::vector<Finding> examine_machine(const std::string& bus_url);

}  // namespace dance
