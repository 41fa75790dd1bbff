// Reads a house as an engine in C++ does, with bindings/unreal/DanceAdapter.hpp: NAME SECONDS.
// Prints each new pose of each dancer, as `pose GUEST SEQUENCE` and where its 22 bones are in
// Unreal's axes, and at the end what the adapter counted.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "bindings/unreal/DanceAdapter.hpp"

namespace {

void print(const dance_guest& guest, const dance_pose& pose, const dance_world& world) {
  std::printf("pose %s %u", guest.id, pose.sequence);
  for (const auto& at : world.position) std::printf(" %.5f %.5f %.5f", at[0], at[1], at[2]);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const dancegraph::Library library(std::getenv("DANCE_ADAPTER_LIBRARY"));
  if (!library) {
    std::fprintf(stderr, "%s\n", library.problem());
    return 1;
  }
  dancegraph::Adapter adapter(library, argv[1], DANCE_AXES_UNREAL);
  dancegraph::GuestList guests;
  std::map<std::string, std::uint32_t> last;
  auto pose = dancegraph::make<dance_pose>();
  auto skeleton = dancegraph::make<dance_skeleton>();
  auto world = dancegraph::make<dance_world>();
  using std::chrono::steady_clock;
  auto turn = steady_clock::now();
  const auto end = turn + std::chrono::duration<double>(std::atof(argv[2]));
  while (turn < end) {
    adapter.guests(guests);
    for (const dance_guest& guest : guests) {
      if (!guest.has_skeleton || adapter.skeleton(guest.slot, skeleton) != DANCE_OK) continue;
      if (adapter.newest(guest.slot, pose) != DANCE_OK) continue;
      const auto known = last.find(guest.id);
      if (known != last.end() && known->second == pose.sequence) continue;
      last[guest.id] = pose.sequence;
      if (adapter.world_of(skeleton, pose, world) == DANCE_OK) print(guest, pose, world);
    }
    turn += std::chrono::microseconds(16667);
    std::this_thread::sleep_until(turn);
  }
  auto counted = dancegraph::make<dance_counters>();
  adapter.counters(counted);
  std::printf("counters %llu %llu %llu %llu %llu\n", static_cast<unsigned long long>(counted.reads),
              static_cast<unsigned long long>(counted.retries),
              static_cast<unsigned long long>(counted.busy),
              static_cast<unsigned long long>(counted.damaged),
              static_cast<unsigned long long>(counted.attached));
  return 0;
}
