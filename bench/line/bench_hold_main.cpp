// dance-bench-hold: what a play-out buffer costs in delay and saves in freezes, over recorded or
// described lines.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/program/figures.h"
#include "core/program/program.h"
#include "testing/line/line_arrivals.h"
#include "transformers/flow.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench hold wifi.csv.xz starlink.csv.xz      over recorded lines
  dance bench hold --link "delay=40ms jitter=15ms loss=2% burst=3"
  dance bench hold --through "hold 30ms" "hold" --link "delay=80ms jitter=40ms"
A dancer at 60 Hz over the line, shown at 60 Hz; simulated time, so that a minute takes a moment.
  added   how much later than the line's least delay a moment is shown
  late    moments that had to repeat a pose
)";

struct Options {
  std::vector<std::string> traces;
  std::string link;
  std::vector<std::string> through{"hold 20ms", "hold 50ms", "hold 100ms", "hold"};
  double seconds = 60.0;
  bool is_json = false;
};

struct Shown {
  double added_p50_ms = 0.0, added_p99_ms = 0.0;
  double late_percent = 0.0;
  double longest_freeze_ms = 0.0;
};

// What a receiver hears: in order, each once, the newest wins.
std::vector<LineArrival> heard_over(LossyModel& line, MonoTime begin, Duration span,
                                    Duration frame) {
  const std::int64_t count = (span.count_ns() + frame.count_ns() - 1) / frame.count_ns();
  std::vector<LineArrival> heard;
  for (const LineArrival& arrival :
       arrivals_over(line, static_cast<std::size_t>(count),
                     [&](std::size_t i) { return begin + frame * static_cast<std::int64_t>(i); }))
    if (heard.empty() || arrival.index > heard.back().index) heard.push_back(arrival);
  return heard;
}

Shown show(Flow& flow, const std::vector<LineArrival>& heard, MonoTime begin, Duration frame) {
  std::vector<double> ages_ms;
  Duration least = Duration::s(1000);
  std::size_t samples = 0, late = 0, in_a_row = 0, longest = 0;
  std::uint64_t starved = 0;
  MonoTime next = heard.empty() ? begin : heard.front().at;
  // The stage's ticks fall between the poses as they will.
  const Duration tick = frame + Duration::us(7);
  for (const LineArrival& arrival : heard) {
    for (; next < arrival.at; next += tick) {
      Pose out;
      if (!flow.sample(next, out)) continue;
      ++samples;
      ages_ms.push_back((next - out.capture_time).as_ms());
      const std::uint64_t now = flow.counters().starved;
      in_a_row = now != starved ? in_a_row + 1 : 0;
      late += now != starved ? 1 : 0;
      starved = now;
      longest = std::max(longest, in_a_row);
    }
    Pose pose;
    pose.sequence = static_cast<std::uint32_t>(arrival.index);
    pose.clock_id = 1;
    pose.capture_time = begin + frame * static_cast<std::int64_t>(arrival.index);
    least = std::min(least, arrival.at - pose.capture_time);
    flow.observe(pose, arrival.at);
  }
  Shown shown;
  if (samples == 0) return shown;
  std::sort(ages_ms.begin(), ages_ms.end());
  const auto added = [&](double fraction) {
    return percentile<double>(ages_ms, fraction) - least.as_ms();
  };
  shown.added_p50_ms = added(0.50);
  shown.added_p99_ms = added(0.99);
  shown.late_percent = 100.0 * static_cast<double>(late) / static_cast<double>(samples);
  shown.longest_freeze_ms = static_cast<double>(longest) * tick.as_ms();
  return shown;
}

Result<void> measure(const std::string& name, const LossyWay& way, const Options& options,
                     nlohmann::ordered_json& report) {
  const Duration frame = Duration::us(16'667);
  const MonoTime begin = MonoTime::from_us(1'000'000);
  LossyModel line(way, 0);
  const auto heard = heard_over(line, begin, Duration::seconds(options.seconds), frame);
  if (heard.size() < 2) return fail(name + ": nothing arrives over this line");
  if (!options.is_json)
    fmt::print("{}: {} of {} poses arrive\n  {:<16}{:>14}{:>14}{:>10}{:>18}\n", name, heard.size(),
               line.counters().offered, "", "added p50 ms", "added p99 ms", "late %",
               "longest freeze ms");
  nlohmann::ordered_json rows;
  for (const std::string& through : options.through) {
    DANCE_TRY(Flow flow, Flow::make({through}));
    const Shown shown = show(flow, heard, begin, frame);
    rows[through] = {{"added_p50_ms", shown.added_p50_ms},
                     {"added_p99_ms", shown.added_p99_ms},
                     {"late_percent", shown.late_percent},
                     {"longest_freeze_ms", shown.longest_freeze_ms}};
    if (!options.is_json)
      fmt::print("  {:<16}{:>14.1f}{:>14.1f}{:>10.2f}{:>18.0f}\n", through, shown.added_p50_ms,
                 shown.added_p99_ms, shown.late_percent, shown.longest_freeze_ms);
  }
  report[name] = rows;
  return {};
}

Result<void> run(const Options& options) {
  nlohmann::ordered_json report;
  if (options.traces.empty()) {
    DANCE_TRY(const LossyLine line, load_line({.link = options.link}));
    const std::string name = options.link.empty() ? "a perfect line" : options.link;
    if (auto done = measure(name, line.up, options, report); !done) return done;
  }
  for (const std::string& path : options.traces) {
    DANCE_TRY(const LossyLine line, load_line({.link = options.link, .traces = {path}}));
    if (auto done = measure(path, line.up, options, report); !done) return done;
  }
  if (options.is_json) std::fputs((report.dump(2) + "\n").c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("What a play-out buffer costs in delay and saves in freezes.",
                          "dance bench hold");
  line.add("trace", options.traces, "recorded lines, as dance lossy takes them");
  line.add("--link", options.link, "what else the line does, as dance lossy takes it");
  line.add("--through", options.through, "the buffers to compare, each a transformer");
  line.add("--seconds", options.seconds, "of dancing").range(1.0, 3600.0).shows_default();
  line.add_flag("--json", options.is_json, "one JSON object instead of the tables");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
