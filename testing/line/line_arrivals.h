// A stream over an emulated line in simulated time: what is sent at known times goes in, what
// arrives comes out in the order of arrival, later ones before earlier ones where the line has it
// so.
//
// Units/frames: times of one clock.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; what the line loses is not among the arrivals.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "testing/line/lossy_model.h"

namespace dance {

struct LineArrival {
  MonoTime at;
  std::size_t index;  // which of those sent
};

// Datagrams of one pose each, number 0 to count - 1, of which each `every`-th is sent.
std::vector<LineArrival> arrivals_over(LossyModel& line, std::size_t count,
                                       const std::function<MonoTime(std::size_t)>& sent_at,
                                       std::size_t every = 1);

// From `begin` on nothing arrives for so long, and then all of it at once.
void stall(std::vector<LineArrival>& arrivals, MonoTime begin, Duration length);

}  // namespace dance
