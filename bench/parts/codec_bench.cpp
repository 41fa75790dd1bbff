// What does the codec that the tunnel speaks cost, and save, against sending the floats as they
// are?
#include <benchmark/benchmark.h>

#include <cstring>

#include "bench/parts/salsa_poses.h"
#include "core/codec/lattice/lattice_codec.h"
#include "core/codec/plain_codec.h"

namespace dance {
namespace {

// 22 rotations and the hips, as floats.
constexpr std::size_t kRawBytes = sizeof(float) * (4 * kBoneCount + 3);
using Payload = std::array<std::uint8_t, kMaxPosePayload>;

void raw_copy(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  Payload payload;
  std::size_t i = 0;
  for (auto _ : state) {
    const Pose& pose = poses[i++ % poses.size()];
    std::memcpy(payload.data(), pose.R_PB.data(), sizeof pose.R_PB);
    std::memcpy(payload.data() + sizeof pose.R_PB, pose.p_WH_m.data(), 3 * sizeof(float));
    benchmark::DoNotOptimize(payload);
  }
  state.counters["bytes"] = static_cast<double>(kRawBytes);
}
BENCHMARK(raw_copy)->Name("codec: encode/baseline");

void plain_encode(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  PlainEncoder encoder;
  Payload payload;
  std::size_t i = 0, bytes = 0;
  for (auto _ : state) {
    bytes += encoder.encode(poses[i++ % poses.size()], payload);
    benchmark::DoNotOptimize(payload);
  }
  state.counters["bytes"] = static_cast<double>(bytes) / static_cast<double>(i);
}
BENCHMARK(plain_encode)->Name("codec: encode/plain");

void raw_read(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  std::vector<Payload> payloads(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    std::memcpy(payloads[i].data(), poses[i].R_PB.data(), sizeof poses[i].R_PB);
  Pose pose;
  std::size_t i = 0;
  for (auto _ : state) {
    const Payload& payload = payloads[i++ % payloads.size()];
    std::memcpy(pose.R_PB.data()->coeffs().data(), payload.data(), sizeof pose.R_PB);
    std::memcpy(pose.p_WH_m.data(), payload.data() + sizeof pose.R_PB, 3 * sizeof(float));
    const bool is_fine = is_valid(pose);
    benchmark::DoNotOptimize(is_fine);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(raw_read)->Name("codec: decode/baseline");

void plain_decode(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  PlainEncoder encoder;
  PlainDecoder decoder;
  std::vector<Payload> payloads(poses.size());
  std::vector<std::size_t> sizes(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) sizes[i] = encoder.encode(poses[i], payloads[i]);
  Pose pose;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % payloads.size();
    const DecodeResult result = decoder.decode(1, {payloads[k].data(), sizes[k]}, pose);
    benchmark::DoNotOptimize(result);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(plain_decode)->Name("codec: decode/plain");

// References one frame old, and intra frames.
template <bool kOnlyKeys>
void lattice_encode(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  LatticeEncoder encoder(built_in_model());
  Payload payload;
  std::size_t bytes = 0, frames = 0;
  for (auto _ : state) {
    const std::size_t k = frames++ % poses.size();
    if (k == 0) encoder.restart();
    if (kOnlyKeys) encoder.request_intra();
    bytes += encoder.encode(poses[k], payload);
    benchmark::DoNotOptimize(payload);
  }
  state.counters["bytes"] = static_cast<double>(bytes) / static_cast<double>(frames);
}
BENCHMARK(lattice_encode<false>)->Name("codec: encode/lattice");
BENCHMARK(lattice_encode<true>)->Name("codec: encode/lattice, intra frames");

template <bool kOnlyKeys>
void lattice_decode(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  LatticeEncoder encoder(built_in_model());
  LatticeDecoder decoder(built_in_model());
  std::vector<Payload> payloads(poses.size());
  std::vector<std::size_t> sizes(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (kOnlyKeys) encoder.request_intra();
    sizes[i] = encoder.encode(poses[i], payloads[i]);
  }
  Pose pose;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % payloads.size();
    const DecodeResult result =
        decoder.decode(poses[k].sequence, {payloads[k].data(), sizes[k]}, pose);
    benchmark::DoNotOptimize(result);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(lattice_decode<false>)->Name("codec: decode/lattice");
BENCHMARK(lattice_decode<true>)->Name("codec: decode/lattice, intra frames");

}  // namespace
}  // namespace dance
