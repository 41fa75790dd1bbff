#include "testing/line/line_options.h"

namespace dance {
namespace {

std::string wrong_link(const std::string& text) {
  const auto spec = LossySpec::parse(text);
  return spec ? std::string() : spec.error().what;
}

}  // namespace

void add_link_options(CommandLine& line, LineWords& words) {
  line.add("--link", words.link,
           "each way: delay=80ms jitter=10ms tail=5ms loss=1% burst=3 dup=0.1% reorder=1% "
           "rate=1Mbit queue=50ms seed=1")
      .check(wrong_link);
  line.add("--link-up", words.link_up,
           "the same for the way to the server; counts more than --link")
      .check(wrong_link);
  line.add("--link-down", words.link_down,
           "the same for the way from the server; counts more than --link")
      .check(wrong_link);
}

void add_trace_options(CommandLine& line, LineWords& words) {
  line.add("--trace", words.traces, kTraceHelp);
  line.add("--trace-up", words.traces_up, "the same, only for the way to the server");
  line.add("--trace-down", words.traces_down, "the same, only for the way from the server");
  line.add("--offset", words.offset_s, "seconds into the traces at which they begin")
      .range(0.0, 1e6);
}

std::vector<std::string> line_arguments(const LineWords& words) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.push_back(std::string(option) + "=" + value);
  };
  add("--link", words.link);
  add("--link-up", words.link_up);
  add("--link-down", words.link_down);
  for (const std::string& path : words.traces) add("--trace", path);
  for (const std::string& path : words.traces_up) add("--trace-up", path);
  for (const std::string& path : words.traces_down) add("--trace-down", path);
  if (words.offset_s > 0.0) add("--offset", std::to_string(words.offset_s));
  return arguments;
}

}  // namespace dance
