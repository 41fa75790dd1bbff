// ReadWatch: whether reading a stage ever kept an engine's thread waiting. A call that waits for
// anything (a lock, a file, the house) gives its processor up of its own will, which the kernel
// counts apart from being put aside for other work; one that goes round and round uses the
// processor.
//
// Units/frames: wall is this machine's clock, processor the time of this thread on it.
// Ownership:    plain value.
// Threads:      those of the caller: one at a time.
// Failure:      none.
// Source:       getrusage(2), ru_nvcsw with RUSAGE_THREAD.
#pragma once

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cstdint>

#include "core/base/time.h"
#include "core/net/mono_clock.h"

namespace dance {

class ReadWatch {
 public:
  // So much of a processor is more than any scene's reading: a call that hangs.
  static constexpr Duration kHangs = Duration::ms(50);

  template <class Reads>
  void operator()(Reads&& reads) {
    const long waits = waits_of_thread();
    const Duration used = used_by_thread();
    const MonoTime begin = mono_now();
    reads();
    longest_wall_ = std::max(longest_wall_, mono_now() - begin);
    const Duration cost = used_by_thread() - used;
    longest_processor_ = std::max(longest_processor_, cost);
    if (waits_of_thread() != waits || cost > kHangs) ++blocked_;
  }

  std::uint64_t blocked() const { return blocked_; }
  Duration longest_wall() const { return longest_wall_; }
  Duration longest_processor() const { return longest_processor_; }

 private:
  static long waits_of_thread() {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_nvcsw;
  }
  static Duration used_by_thread() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return Duration::s(t.tv_sec) + Duration::ns(t.tv_nsec);
  }

  std::uint64_t blocked_ = 0;
  Duration longest_wall_;
  Duration longest_processor_;
};

}  // namespace dance
