// What a recording costs for a pose of a dancer: as MCAP and as a table, beside the plain event of
// an LCM log.
#include <benchmark/benchmark.h>

#include <string>

#include "bench/parts/salsa_poses.h"
#include "consumers/text/csv_consumer.h"
#include "formats/mcap/dance_mcap_writer.h"
#include "formats/recording/log_sink.h"

namespace dance {
namespace {

constexpr std::int64_t kEvening_us = 1'772'395'530'000'000;
constexpr std::int64_t kFrame_us = 16'667;
const GuestId kAlice = GuestId::parse("alice").value();

void as_log(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  LogSink log(LogWriter::append_to("/dev/null").value(), Where::kStage);
  std::int64_t i = 0;
  for (auto _ : state) {
    log.on_pose(kAlice, poses[static_cast<std::size_t>(i) % poses.size()],
                kEvening_us + i * kFrame_us);
    ++i;
  }
}
BENCHMARK(as_log)->Name("files: a pose recorded/baseline");

void as_mcap(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  std::size_t bytes = 0;
  DanceMcapWriter writer([&](std::span<const std::uint8_t> more) { bytes += more.size(); });
  std::int64_t i = 0;
  for (auto _ : state) {
    writer.on_pose(kAlice, poses[static_cast<std::size_t>(i) % poses.size()],
                   kEvening_us + i * kFrame_us);
    // As a live recording does every second.
    if (++i % 60 == 0) writer.end_chunk();
  }
  state.counters["bytes"] = static_cast<double>(bytes) / static_cast<double>(i);
}
BENCHMARK(as_mcap)->Name("files: a pose recorded/MCAP");

void as_table(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  CsvConsumer table(OutputFile::open("/dev/null").value(), 0.0);
  std::int64_t i = 0;
  for (auto _ : state) {
    table.on_pose(kAlice, poses[static_cast<std::size_t>(i) % poses.size()],
                  MonoTime::from_us(kEvening_us + i * kFrame_us));
    ++i;
  }
}
BENCHMARK(as_table)->Name("files: a pose recorded/CSV");

}  // namespace
}  // namespace dance
