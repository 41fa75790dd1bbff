#include "testing/line/capacity_trace.h"

#include <algorithm>
#include <charconv>

#include "core/base/take_line.h"
#include "testing/line/trace_file.h"

namespace dance {
namespace {

constexpr std::size_t kMostOpportunities = 8'000'000;
constexpr std::uint32_t kLongest_ms = 1'000'000'000;

}  // namespace

Result<CapacityTrace> CapacityTrace::parse(std::string_view text) {
  if (text.size() > kMostTraceBytes) return fail("a trace has at most 64 MB");
  CapacityTrace trace;
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    const std::string_view row = take_line(text);
    if (row.empty()) continue;
    std::uint32_t ms = 0;
    const auto [stop, error] = std::from_chars(row.data(), row.data() + row.size(), ms);
    if (error != std::errc() || stop != row.data() + row.size() || ms > kLongest_ms)
      return broken_trace_line(
          line, "a capacity trace has a whole number of milliseconds on each line, not", row);
    if (!trace.times_ms_.empty() && ms < trace.times_ms_.back())
      return broken_trace_line(line, "time goes backwards:", row);
    if (trace.times_ms_.size() == kMostOpportunities)
      return fail("a capacity trace has at most 8,000,000 lines");
    trace.times_ms_.push_back(ms);
  }
  if (trace.times_ms_.empty()) return fail("the trace has no rows");
  if (trace.times_ms_.back() == 0)
    return broken_trace_line(
        line, "the last number is the trace's length, after which it is repeated; it cannot be",
        "0");
  return trace;
}

Duration CapacityTrace::at(Number opportunity) const {
  const std::uint64_t round = opportunity / times_ms_.size();
  return length() * static_cast<std::int64_t>(round) +
         Duration::ms(times_ms_[opportunity % times_ms_.size()]);
}

CapacityTrace::Number CapacityTrace::first_from(Duration since_begin) const {
  if (since_begin <= Duration()) return 0;
  // Two rounds meet in one moment, which belongs to the earlier one.
  const std::int64_t round = (since_begin.count_ns() - 1) / length().count_ns();
  const std::int64_t in_round_ns = since_begin.count_ns() - round * length().count_ns();
  const auto first =
      std::lower_bound(times_ms_.begin(), times_ms_.end(), in_round_ns,
                       [](std::uint32_t ms, std::int64_t ns) { return ms * 1'000'000LL < ns; });
  return static_cast<Number>(round) * times_ms_.size() +
         static_cast<Number>(first - times_ms_.begin());
}

double CapacityTrace::mean_bps() const {
  return static_cast<double>(size() * kOpportunity_bytes) * 8.0 / length().as_seconds();
}

}  // namespace dance
