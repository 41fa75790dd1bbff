#include "core/program/talk.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cctype>

#include "core/base/text/plain_text.h"

namespace dance::talk {

void line(Level level, fmt::string_view format, fmt::format_args args) {
  const std::string text = plain_text(fmt::vformat(format, args));
  switch (level) {
    case Level::kInfo:
      spdlog::info(text);
      return;
    case Level::kWarn:
      spdlog::warn(text);
      return;
    case Level::kError:
      spdlog::error(text);
      return;
  }
}

std::string_view without_time(std::string_view line) {
  constexpr std::string_view kForm = "00:00:00.000 ";
  if (line.size() < kForm.size()) return line;
  for (std::size_t i = 0; i < kForm.size(); ++i)
    if (kForm[i] == '0' ? std::isdigit(static_cast<unsigned char>(line[i])) == 0
                        : line[i] != kForm[i])
      return line;
  return line.substr(kForm.size());
}

void begin(const std::string& program) {
  auto logger = spdlog::stderr_logger_mt(program);
  logger->set_pattern("%H:%M:%S.%e %n: %v");
  spdlog::set_default_logger(logger);
}

}  // namespace dance::talk
