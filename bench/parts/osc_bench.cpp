// What does a pose cost as Open Sound Control, for avatar apps, against the same pose as a message
// of the bus? Time to encode one pose, and its bytes.
#include <benchmark/benchmark.h>

#include "bench/parts/salsa_poses.h"
#include "core/bus/encode.h"
#include "formats/osc/vmc_writer.h"
#include "formats/osc/vrchat_writer.h"

namespace dance {
namespace {

class CountedBytes : public OscPacketSink {
 public:
  void on_packet(std::span<const std::uint8_t> packet) override {
    bytes += packet.size();
    benchmark::DoNotOptimize(packet.data());
  }
  std::size_t bytes = 0;
};

void as_message(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  MessageBuffer buffer;
  std::size_t i = 0;
  std::size_t bytes = 0;
  for (auto _ : state) {
    bytes = encode(poses[i++ % poses.size()], buffer);
    benchmark::DoNotOptimize(buffer);
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(as_message)->Name("osc: a pose/baseline");

void as_vmc(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  CountedBytes counted;
  VmcWriter writer(counted, VmcDialect::kVrm0);
  const Hands hands;
  std::size_t i = 0;
  for (auto _ : state) writer.write_pose(poses[i++ % poses.size()], &hands, 1.0f);
  state.counters["bytes"] = static_cast<double>(counted.bytes) / static_cast<double>(i);
}
BENCHMARK(as_vmc)->Name("osc: a pose/vmc");

void as_trackers(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  CountedBytes counted;
  VrchatWriter writer(counted);
  std::size_t i = 0;
  for (auto _ : state) writer.write_pose(poses[i++ % poses.size()]);
  state.counters["bytes"] = static_cast<double>(counted.bytes) / static_cast<double>(i);
}
BENCHMARK(as_trackers)->Name("osc: a pose/vrchat");

}  // namespace
}  // namespace dance
