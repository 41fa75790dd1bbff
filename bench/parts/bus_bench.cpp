// What does it cost to make a checked Pose of a message, and a message of a Pose, against LCM's
// generated code alone?
#include <benchmark/benchmark.h>

#include <dancelcm/pose_t.hpp>

#include "bench/parts/salsa_poses.h"
#include "core/bus/encode.h"

namespace dance {
namespace {

std::vector<MessageBuffer> messages(std::size_t& size) {
  std::vector<MessageBuffer> result;
  for (const Pose& pose : salsa_poses()) size = encode(pose, result.emplace_back());
  return result;
}

void generated_decode(benchmark::State& state) {
  std::size_t size = 0;
  const auto buffers = messages(size);
  std::size_t i = 0;
  dancelcm::pose_t message{};
  for (auto _ : state) {
    message.decode(buffers[i++ % buffers.size()].data(), 0, static_cast<int>(size));
    benchmark::DoNotOptimize(message);
  }
}
BENCHMARK(generated_decode)->Name("bus: message to pose/baseline");

void our_decode(benchmark::State& state) {
  std::size_t size = 0;
  const auto buffers = messages(size);
  std::size_t i = 0;
  Pose pose;
  for (auto _ : state) {
    const Decoded result = decode(buffers[i++ % buffers.size()].data(), size, pose);
    benchmark::DoNotOptimize(result);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(our_decode)->Name("bus: message to pose/ours, with its checks");

void generated_encode(benchmark::State& state) {
  std::size_t size = 0;
  const auto buffers = messages(size);
  std::vector<dancelcm::pose_t> decoded(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i)
    decoded[i].decode(buffers[i].data(), 0, static_cast<int>(size));
  MessageBuffer out;
  std::size_t i = 0;
  for (auto _ : state) {
    decoded[i++ % decoded.size()].encode(out.data(), 0, static_cast<int>(out.size()));
    benchmark::DoNotOptimize(out);
  }
}
BENCHMARK(generated_encode)->Name("bus: pose to message/baseline");

void our_encode(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  MessageBuffer out;
  std::size_t i = 0, size = 0;
  for (auto _ : state) {
    size = encode(poses[i++ % poses.size()], out);
    benchmark::DoNotOptimize(out);
  }
  state.counters["bytes"] = static_cast<double>(size);
}
BENCHMARK(our_encode)->Name("bus: pose to message/ours");

}  // namespace
}  // namespace dance
