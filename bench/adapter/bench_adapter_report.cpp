#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/adapter/bench_adapter.h"
#include "core/program/figures.h"

namespace dance {
namespace {

// From the camera's shutter to the engine, of the reference implementation, in its paper.
constexpr double kReferenceToEngine_ms = 24.8;

double at(Durations& durations, double fraction) {
  std::sort(durations.begin(), durations.end());
  return percentile<Duration>(durations, fraction).as_us();
}

}  // namespace

std::string bench_adapter_table(const BenchAdapterOptions& options, BenchAdapterResult& result) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "{} dancers at {:g} Hz, {:g} s each; {} reads, {} torn, {} gave up\n",
                 options.guests, options.hz, options.seconds, result.reads, result.torn,
                 result.gave_up);
  const ReadWatch& watch = result.watch;
  fmt::format_to(
      back,
      "of an engine's reads of all dancers {} blocked; the longest took {:.0f} µs, {:.0f} "
      "of them on a processor\n\n",
      watch.blocked(), watch.longest_wall().as_us(), watch.longest_processor().as_us());
  const auto row = [&](const char* name, Durations& durations) {
    fmt::format_to(back, "  {:<52}{:>9.1f}{:>9.1f}{:>9.1f}\n", name, at(durations, 0.5),
                   at(durations, 0.99), at(durations, 1.0));
  };
  fmt::format_to(back, "  {:<52}{:>9}{:>9}{:>9}\n", "from … to a reader that waits for it (µs)",
                 "p50", "p99", "max");
  row("the write into the memory, nothing else running", result.memory.staged);
  row("… while the reader was not put aside for other work", result.memory.on_processor);
  row("the stage of the house, another process", result.house.staged);
  row("… while the reader was not put aside for other work", result.house.on_processor);
  row("the capture, published on the bus", result.house.captured);
  row("the capture, to a program on the bus instead", result.capture_to_lcm);
  fmt::format_to(back, "  {:<52}{:>9.0f}\n\n", "the capture, of the reference implementation",
                 1000.0 * kReferenceToEngine_ms);
  for (FrameLoop& loop : result.loops) {
    fmt::format_to(back, "  {:<52}{:>9}{:>9}{:>9}\n",
                   fmt::format("an engine at {:g} Hz (µs)", loop.hz), "p50", "p99", "max");
    row("reads all dancers for the time of display", loop.read_at);
    row("… and at once again", loop.read_again);
    row("reads all dancers as they came", loop.read_newest);
    row("copies as many bytes", loop.copied);
    row("drains a hop of the bus instead", loop.drained);
    row("age of the poses at their use, read then", loop.age_late);
    row("age of the poses at their use, read at the frame's begin", loop.age_early);
    row("… of a hop of the bus, drained at the frame's begin", loop.age_other_early);
    out += "\n";
  }
  return out;
}

std::string bench_adapter_json(const BenchAdapterOptions& options, BenchAdapterResult& result) {
  nlohmann::ordered_json report{
      {"guests", options.guests}, {"hz", options.hz}, {"seconds", options.seconds}};
  const auto us = [&](const std::string& key, Durations& durations) {
    report[key + "_us_p50"] = rounded(at(durations, 0.5), 100.0);
    report[key + "_us_p99"] = rounded(at(durations, 0.99), 100.0);
  };
  FrameLoop& fastest = result.loops.back();
  us("read", fastest.read_at);
  us("publish_to_read", result.memory.staged);
  report["age_at_use_ms_p50"] = rounded(at(fastest.age_late, 0.5) * 1e-3, 1000.0);
  report["torn"] = result.torn;
  report["blocked"] = result.watch.blocked();
  report["gave_up"] = result.gave_up;
  report["longest_read_us"] = rounded(result.watch.longest_wall().as_us(), 100.0);
  report["longest_read_processor_us"] = rounded(result.watch.longest_processor().as_us(), 100.0);
  report["reads"] = result.reads;
  us("publish_to_read_on_processor", result.memory.on_processor);
  us("house_to_read", result.house.staged);
  us("house_to_read_on_processor", result.house.on_processor);
  us("capture_to_read", result.house.captured);
  us("capture_to_lcm", result.capture_to_lcm);
  report["reference_to_engine_ms"] = kReferenceToEngine_ms;
  us("read_again", fastest.read_again);
  us("read_newest", fastest.read_newest);
  us("baseline_copy", fastest.copied);
  us("baseline_lcm_drain", fastest.drained);
  for (FrameLoop& loop : result.loops) {
    const std::string hz = fmt::format("_{:g}hz_ms_p50", loop.hz);
    report["age_late" + hz] = rounded(at(loop.age_late, 0.5) * 1e-3, 1000.0);
    report["age_early" + hz] = rounded(at(loop.age_early, 0.5) * 1e-3, 1000.0);
    report["age_lcm_early" + hz] = rounded(at(loop.age_other_early, 0.5) * 1e-3, 1000.0);
  }
  return report.dump(2) + "\n";
}

}  // namespace dance
