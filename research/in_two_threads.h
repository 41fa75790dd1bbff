// Work that falls into parts, on two threads: what trains models needs no more cores than anybody
// has.
//
// Units/frames: none.
// Ownership:    keeps nothing.
// Threads:      work(0), work(1), … below count: even ones here, odd ones on a thread that ends
//               with the call.
// Failure:      none of its own; what work throws on the other thread ends the program.
#pragma once

#include <cstddef>
#include <thread>

namespace dance {

template <class Work>
void in_two_threads(std::size_t count, const Work& work) {
  const auto every_other = [&](std::size_t i) {
    for (; i < count; i += 2) work(i);
  };
  std::thread other(every_other, 1);
  every_other(0);
  other.join();
}

}  // namespace dance
