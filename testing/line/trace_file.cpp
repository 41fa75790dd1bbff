#include "testing/line/trace_file.h"

#include "core/program/whole_file.h"

namespace dance {

Result<std::string> read_trace_file(const std::string& path) {
  auto text = read_whole_file(path, kMostTraceBytes);
  if (!text) return fail("trace " + text.error().what);
  text = unpacked(std::move(*text), kMostTraceBytes);
  if (!text) return fail("trace " + path + ": " + text.error().what);
  return text;
}

tl::unexpected<Error> broken_trace_line(std::size_t line, const char* what, std::string_view text) {
  std::string quote(text.substr(0, 40));
  for (char& c : quote)
    if (c < ' ' || c > '~') c = '?';
  return fail("line " + std::to_string(line) + ": " + what + " '" + quote + "'");
}

}  // namespace dance
