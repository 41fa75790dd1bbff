#include "testing/line/lossy_line.h"

#include <algorithm>

#include "testing/line/trace_file.h"

namespace dance {
namespace {

Result<void> add_trace(const RecordedTrace& trace, const std::string& path, const char* direction,
                       LossyWay& way) {
  if (trace.delay) way.delays.push_back(trace.delay);
  if (!trace.capacity) return {};
  if (way.capacity)
    return fail("trace '" + path + "' is the second capacity trace of the way " + direction +
                ": give one for each way");
  way.capacity = trace.capacity;
  return {};
}

Result<void> add_traces(const std::vector<std::string>& paths, bool is_up, bool is_down,
                        LossyLine& line) {
  for (const std::string& path : paths) {
    DANCE_TRY(const RecordedTrace trace, load_trace(path));
    if (is_up)
      if (auto added = add_trace(trace, path, "up", line.up); !added) return added;
    if (is_down)
      if (auto added = add_trace(trace, path, "down", line.down); !added) return added;
  }
  return {};
}

bool is_number(std::string_view row) {
  return std::all_of(row.begin(), row.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::optional<Duration> time_on(const LossyWay& way, Duration since_begin) {
  const Duration at = since_begin + way.offset;
  if (way.spec.loss >= 1.0) return std::nullopt;
  Duration took = way.spec.delay;
  for (const auto& trace : way.delays) {
    const DelayTrace::Point& point = trace->at(at);
    if (point.loss >= 1.0f) return std::nullopt;
    took += point.delay;
  }
  if (!way.capacity) return took;
  const Duration waits = way.capacity->at(way.capacity->first_from(at)) - at;
  if (waits > way.spec.queue) return std::nullopt;
  return took + waits;
}

Result<RecordedTrace> parse_trace(std::string_view text) {
  const auto begin = std::min(text.find_first_not_of("\r\n"), text.size());
  const auto end = std::min(text.find_first_of("\r\n", begin), text.size());
  const std::string_view first = text.substr(begin, end - begin);
  RecordedTrace trace;
  if (first.empty()) return fail("the trace has no rows");
  if (is_number(first)) {
    DANCE_TRY(CapacityTrace capacity, CapacityTrace::parse(text));
    trace.capacity = std::make_shared<const CapacityTrace>(std::move(capacity));
  } else if (first.find(',') != std::string_view::npos) {
    DANCE_TRY(DelayTrace delay, DelayTrace::parse(text));
    trace.delay = std::make_shared<const DelayTrace>(std::move(delay));
  } else {
    return broken_trace_line(1,
                             "a trace begins with a header (t_ms or t_s, and owd_var_ms or rtt_ms, "
                             "with commas), or is a whole number of milliseconds on each line; not",
                             first);
  }
  return trace;
}

Result<RecordedTrace> load_trace(const std::string& path) {
  DANCE_TRY(const std::string text, read_trace_file(path));
  auto trace = parse_trace(text);
  if (!trace) return fail("trace '" + path + "', " + trace.error().what);
  return trace;
}

Result<LossyLine> load_line(const LineWords& words) {
  LossyLine line;
  DANCE_TRY(line.up.spec, LossySpec::parse(words.link + " " + words.link_up));
  DANCE_TRY(line.down.spec, LossySpec::parse(words.link + " " + words.link_down));
  line.up.offset = line.down.offset = Duration::seconds(words.offset_s);
  if (auto added = add_traces(words.traces, true, true, line); !added)
    return tl::make_unexpected(added.error());
  if (auto added = add_traces(words.traces_up, true, false, line); !added)
    return tl::make_unexpected(added.error());
  if (auto added = add_traces(words.traces_down, false, true, line); !added)
    return tl::make_unexpected(added.error());
  return line;
}

}  // namespace dance
