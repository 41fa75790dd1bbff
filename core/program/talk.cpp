#include "core/program/talk.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace dance::talk {

void line(Level level, fmt::string_view format, fmt::format_args args) {
  const std::string text = fmt::vformat(format, args);
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

void begin(const std::string& program) {
  auto logger = spdlog::stderr_logger_mt(program);
  logger->set_pattern("%H:%M:%S.%e %n: %v");
  spdlog::set_default_logger(logger);
}

}  // namespace dance::talk
