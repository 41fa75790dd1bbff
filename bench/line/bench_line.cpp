#include "bench/line/bench_line.h"

#include <algorithm>
#include <ctime>

#include "bench/parts/salsa_poses.h"
#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

// For what is still under way when the dance ends,
constexpr Duration kUnderWay = Duration::s(2);
// and for state, which is repeated until it is there.
constexpr Duration kTimeout = Duration::s(15);
constexpr double kBusy_percent = 80.0;

struct PlannedLine {
  std::string name;
  LossyLine line;
};

Duration cpu_of_this_process() {
  timespec time{};
  if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) != 0) return Duration();
  return Duration::s(time.tv_sec) + Duration::ns(time.tv_nsec);
}

// a/b/wifi.csv.xz is called wifi.
std::string short_name(const std::string& path) {
  std::string name = path.substr(path.find_last_of('/') + 1);
  for (const char* ending : {".xz", ".csv"})
    if (name.ends_with(ending)) name.resize(name.size() - std::string(ending).size());
  return name;
}

// lte.up and lte.down are called lte.
std::string shared_name(const std::string& up, const std::string& down) {
  if (up == down) return up;
  const auto differ = std::mismatch(up.begin(), up.end(), down.begin(), down.end());
  const std::string shared(up.begin(), differ.first);
  const auto separator = shared.find_last_of("._-");
  if (separator == std::string::npos || separator == 0) return up + "," + down;
  return shared.substr(0, separator);
}

std::string text_of(double seconds) {
  std::string text = std::to_string(seconds);
  text.resize(std::min(text.find_last_not_of('0') + 1, text.size()));
  if (text.ends_with('.')) text.pop_back();
  return text;
}

// The line of one argument: a file, or two with a comma between.
Result<PlannedLine> plan_file(const std::string& argument, const LineWords& link, double offset_s) {
  LineWords words = link;
  words.offset_s = offset_s;
  PlannedLine planned;
  const auto comma = argument.find(',');
  if (comma == std::string::npos) {
    words.traces = {argument};
    planned.name = short_name(argument);
  } else {
    words.traces_up = {argument.substr(0, comma)};
    words.traces_down = {argument.substr(comma + 1)};
    planned.name = shared_name(short_name(words.traces_up[0]), short_name(words.traces_down[0]));
  }
  if (offset_s > 0.0) planned.name += " @" + text_of(offset_s) + "s";
  DANCE_TRY(planned.line, load_line(words));
  return planned;
}

Result<std::vector<PlannedLine>> plan(const BenchLineOptions& options) {
  std::vector<PlannedLine> lines;
  lines.push_back({"clean", LossyLine()});
  for (const std::string& file : options.files)
    for (const double offset_s : options.offsets_s) {
      DANCE_TRY(PlannedLine planned, plan_file(file, options.link, offset_s));
      lines.push_back(std::move(planned));
    }
  if (options.files.empty() && !options.link.is_perfect_line()) {
    DANCE_TRY(LossyLine line, load_line(options.link));
    lines.push_back({"described", std::move(line)});
  }
  return lines;
}

class Batch {
 public:
  Batch(const BenchLineOptions& options, const LineDance& dance, Poller& poller)
      : span_(Duration::seconds(options.seconds)), dance_(dance), poller_(poller) {}

  Result<void> run(std::span<const PlannedLine> lines, BenchLineResult& result) {
    const MonoTime begin = mono_now();
    const Duration cpu = cpu_of_this_process();
    for (const PlannedLine& planned : lines) {
      DANCE_TRY(auto lane, LineLane::open(planned.name, planned.line, dance_, span_, poller_));
      lanes_.push_back(std::move(lane));
      // Not all in the same instant of each frame.
      turn_until(mono_now() + dance_.frame / static_cast<std::int64_t>(lines.size()));
    }
    turn_until(begin + span_);
    result.cpu_percent =
        std::max(result.cpu_percent, 100.0 * (cpu_of_this_process() - cpu).as_seconds() /
                                         (mono_now() - begin).as_seconds());
    turn_until(mono_now() + kUnderWay);
    const MonoTime give_up = mono_now() + kTimeout;
    while (!all_have_converged() && mono_now() < give_up && !poller_.is_stopped())
      turn_until(mono_now() + Duration::ms(20));
    if (poller_.is_stopped()) return fail("stopped by a signal before the end");
    for (const auto& lane : lanes_) result.lines.push_back(lane->result());
    return {};
  }

 private:
  void turn_until(MonoTime end) {
    for (MonoTime now = mono_now(); now < end && !poller_.is_stopped(); now = mono_now())
      poller_.run_once(std::min(Duration::ms(20), end - now));
  }
  bool all_have_converged() const {
    return std::all_of(lanes_.begin(), lanes_.end(),
                       [](const auto& lane) { return lane->has_converged(); });
  }

  Duration span_;
  const LineDance& dance_;
  Poller& poller_;
  std::vector<std::unique_ptr<LineLane>> lanes_;
};

}  // namespace

Result<BenchLineResult> run_bench_line(const BenchLineOptions& options) {
  DANCE_TRY(const std::vector<PlannedLine> lines, plan(options));
  const LineDance dance{Duration::period_of_hz(options.hz), salsa_poses(SalsaRole::kLead),
                        salsa_poses(SalsaRole::kFollow)};
  DANCE_TRY(const auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return tl::make_unexpected(stops.error());
  BenchLineResult result;
  const auto at_once = static_cast<std::size_t>(options.at_once);
  for (std::size_t first = 0; first < lines.size(); first += at_once) {
    const auto some = std::span(lines).subspan(first, std::min(at_once, lines.size() - first));
    if (auto done = Batch(options, dance, *poller).run(some, result); !done)
      return tl::make_unexpected(done.error());
  }
  if (result.cpu_percent > kBusy_percent)
    talk::warn("{:.0f} % of a core: too much to trust the figures; try less with --at-once",
               result.cpu_percent);
  return result;
}

Result<void> check_lines(const BenchLineResult& result) {
  for (const LineResult& line : result.lines) {
    for (const LineWayResult* way : {&line.up, &line.down})
      if (way->figures.older_delivered + way->figures.older_shown > 0)
        return fail(line.name + ": a pose was delivered or shown after a newer one");
    if (!line.has_converged)
      return fail(line.name +
                  ": the houses do not know each other's presence and skeletons at the end");
  }
  return {};
}

}  // namespace dance
