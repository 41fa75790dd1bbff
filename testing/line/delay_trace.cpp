#include "testing/line/delay_trace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/base/assert.h"
#include "core/base/take_line.h"
#include "testing/line/trace_file.h"

namespace dance {
namespace {

constexpr std::size_t kMostPoints = 2'000'000;
constexpr std::size_t kMostColumns = 16;
constexpr double kLongestDelay_ms = 60'000.0;
constexpr double kLongestTime_s = 1e6;

struct Columns {
  int run = -1;
  int time = -1;
  double time_to_s = 1.0;
  int delay = -1;
  double delay_to_one_way = 1.0;
  int loss = -1;
};

using Cells = std::array<std::string_view, kMostColumns>;

std::size_t split(std::string_view line, Cells& cells) {
  std::size_t count = 0;
  for (;;) {
    const auto comma = line.find(',');
    if (count < cells.size()) cells[count] = line.substr(0, comma);
    ++count;
    if (comma == std::string_view::npos) return count;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

Result<Columns> read_header(std::string_view line) {
  Columns columns;
  Cells cells;
  const std::size_t count = std::min(split(line, cells), kMostColumns);
  for (std::size_t i = 0; i < count; ++i) {
    const int at = static_cast<int>(i);
    if (cells[i] == "run") columns.run = at;
    if (cells[i] == "loss") columns.loss = at;
    if (cells[i] == "t_s") columns.time = at;
    if (cells[i] == "t_ms") columns.time = at, columns.time_to_s = 1e-3;
    if (cells[i] == "owd_var_ms") columns.delay = at;
    if (cells[i] == "rtt_ms") columns.delay = at, columns.delay_to_one_way = 0.5;
  }
  if (columns.time < 0 || columns.delay < 0)
    return fail(
        "line 1: a trace begins with a header that names t_ms or t_s, and owd_var_ms or "
        "rtt_ms");
  return columns;
}

// One row's point; its time still counts from the begin of its run.
Result<DelayTrace::Point> read_row(const Columns& columns, const Cells& cells, std::size_t count,
                                   std::size_t line) {
  const auto cell = [&](int column) {
    const auto i = static_cast<std::size_t>(column);
    return i < count ? cells[i] : std::string_view();
  };
  DelayTrace::Point point;
  const auto time = number(cell(columns.time));
  if (!time || *time < 0.0 || *time * columns.time_to_s > kLongestTime_s)
    return broken_trace_line(line, "not a time:", cell(columns.time));
  point.at = Duration::seconds(*time * columns.time_to_s);
  const std::string_view delay_text = cell(columns.delay);
  if (delay_text.empty()) {
    point.loss = 1.0f;
  } else {
    const auto delay = number(delay_text);
    if (!delay || *delay < 0.0 || *delay > kLongestDelay_ms)
      return broken_trace_line(line, "not a delay in ms:", delay_text);
    point.delay = Duration::seconds(*delay * columns.delay_to_one_way * 1e-3);
  }
  if (columns.loss >= 0 && !cell(columns.loss).empty()) {
    const auto loss = number(cell(columns.loss));
    if (!loss || *loss < 0.0 || *loss > 1.0)
      return broken_trace_line(line, "not a loss of 0 to 1:", cell(columns.loss));
    point.loss = std::max(point.loss, static_cast<float>(*loss));
  }
  return point;
}

}  // namespace

Result<DelayTrace> DelayTrace::parse(std::string_view csv) {
  if (csv.size() > kMostTraceBytes) return fail("a trace has at most 64 MB");
  DelayTrace trace;
  std::optional<Columns> columns;
  Cells cells;
  std::string_view run;
  Duration run_begin;
  Duration gap;  // between the last two points: what stands between runs and before a repetition
  for (std::size_t line = 1; !csv.empty(); ++line) {
    const std::string_view row = take_line(csv);
    if (!columns) {
      DANCE_TRY(columns, read_header(row));
      continue;
    }
    if (row.empty()) continue;
    const std::size_t count = std::min(split(row, cells), kMostColumns);
    DANCE_TRY(Point point, read_row(*columns, cells, count, line));
    if (columns->run >= 0 && static_cast<std::size_t>(columns->run) < count) {
      const std::string_view this_run = cells[static_cast<std::size_t>(columns->run)];
      if (this_run != run && !trace.points_.empty())
        run_begin = trace.points_.back().at + gap - point.at;
      run = this_run;
    }
    point.at += run_begin;
    if (!trace.points_.empty()) {
      const Duration step = point.at - trace.points_.back().at;
      if (step < Duration()) return broken_trace_line(line, "time goes backwards:", row);
      if (step > Duration()) gap = step;
    }
    if (trace.points_.size() == kMostPoints) return fail("a trace has at most 2,000,000 rows");
    trace.points_.push_back(point);
  }
  if (trace.points_.empty()) return fail("the trace has no rows");
  if (gap == Duration()) gap = Duration::ms(10);
  trace.length_ = trace.points_.back().at + gap;
  return trace;
}

const DelayTrace::Point& DelayTrace::at(Duration since_begin) const {
  DANCE_ASSERT(!points_.empty());
  const Duration in_loop = Duration::ns(since_begin.count_ns() % length_.count_ns());
  const auto after = std::upper_bound(points_.begin(), points_.end(), in_loop,
                                      [](Duration t, const Point& p) { return t < p.at; });
  return after == points_.begin() ? points_.front() : *(after - 1);
}

}  // namespace dance
