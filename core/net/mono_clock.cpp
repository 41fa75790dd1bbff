#include "core/net/mono_clock.h"

#include <ctime>
#include <fstream>
#include <random>
#include <string>

#include "core/base/fnv1a.h"

namespace dance {
namespace {

std::uint64_t make_clock_id() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string boot_id;
  std::uint64_t id = 0;
  if (std::getline(file, boot_id) && boot_id.size() >= 32) {
    id = fnv1a(boot_id) >> 1;  // positive in an int64_t, for readers in other languages
  } else {
    std::random_device random;
    id = ((static_cast<std::uint64_t>(random()) << 32) | random()) >> 1;
  }
  return id == 0 ? 1 : id;
}

}  // namespace

MonoTime mono_now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return MonoTime::from_ns(static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec);
}

std::uint64_t this_clock_id() {
  static const std::uint64_t id = make_clock_id();
  return id;
}

}  // namespace dance
