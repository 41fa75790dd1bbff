// What a program says to its user while it runs: lines on stderr with the time and the program's
// name. Stdout is data. Formats are checked when they are compiled and worked out in one place, so
// that a file that talks costs no more to build than one that does not. Never on the pose path.
//
// Ownership: nothing is kept.
// Threads:   any.
// Failure:   what cannot be written is lost.
#pragma once

#include <fmt/core.h>

namespace dance::talk {

enum class Level { kInfo, kWarn, kError };
void line(Level level, fmt::string_view format, fmt::format_args args);

template <class... T>
void info(fmt::format_string<T...> format, T&&... args) {
  line(Level::kInfo, format, fmt::make_format_args(args...));
}
template <class... T>
void warn(fmt::format_string<T...> format, T&&... args) {
  line(Level::kWarn, format, fmt::make_format_args(args...));
}
template <class... T>
void error(fmt::format_string<T...> format, T&&... args) {
  line(Level::kError, format, fmt::make_format_args(args...));
}

// From here on lines bear this name. run_program() does it.
void begin(const std::string& program);

}  // namespace dance::talk
