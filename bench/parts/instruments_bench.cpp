// What do the instruments cost the thread that hears the bus, for each pose of thirty guests that
// came and was staged, against decoding the two messages?
#include <benchmark/benchmark.h>

#include <string>

#include "bench/parts/salsa_poses.h"
#include "core/bus/encode.h"
#include "viewer/instruments/instrument_board.h"

namespace dance {
namespace {

constexpr int kGuests = 30;

void decoding(benchmark::State& state) {
  MessageBuffer buffer;
  const std::size_t size = encode(salsa_poses()[0], buffer);
  Pose pose;
  for (auto _ : state) {
    for (int i = 0; i < 2; ++i) {
      decode(buffer.data(), size, pose);
      benchmark::DoNotOptimize(pose);
    }
  }
}
BENCHMARK(decoding)->Name("instruments: a pose of 30 guests/baseline");

void measuring(benchmark::State& state, Duration ahead) {
  const std::vector<Pose> poses = salsa_poses();
  InstrumentBoard board(poses[0].clock_id);
  std::vector<GuestId> guests;
  for (int g = 0; g < kGuests; ++g) guests.push_back(*GuestId::parse("guest-" + std::to_string(g)));
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t picture = i / kGuests;
    const GuestId& guest = guests[i % kGuests];
    Pose pose = poses[picture % poses.size()];
    pose.sequence = static_cast<std::uint32_t>(picture);
    pose.capture_time =
        poses[0].capture_time + Duration::us(static_cast<std::int64_t>(picture) * 16'667);
    const MonoTime now = pose.capture_time + Duration::ms(60);
    board.on_pose(Where::kGuest, guest, pose, now);
    pose.capture_time += ahead;
    board.on_pose(Where::kStage, guest, pose, now);
    if (i++ % (6 * kGuests) == 0)
      board.end_seconds(
          now, [](const GuestId&, const GuestStats& stats) { benchmark::DoNotOptimize(&stats); });
  }
}
BENCHMARK_CAPTURE(measuring, shown_as_come, Duration())
    ->Name("instruments: a pose of 30 guests/measured");
BENCHMARK_CAPTURE(measuring, predicted, Duration::ms(60))
    ->Name("instruments: a pose of 30 guests/measured, predicted");

}  // namespace
}  // namespace dance
