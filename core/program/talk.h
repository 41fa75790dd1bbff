// Messages of a running program to its user: lines on stderr with the time and the program's name.
// Formats are checked at compile time and formatted in one place, to keep compile times low. Never
// on the pose path.
//
// Ownership: none.
// Threads:   any.
// Failure:   lines that cannot be written are lost.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>

namespace dance::talk {

enum class Level { kInfo, kWarn, kError };
// Control characters, and characters that change the direction of text, become '?': parts of a
// message may come from files and from the network.
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

// "12:34:56.789 dance join: …" without the time; any other line as it is.
std::string_view without_time(std::string_view line);

// Sets the name on all further lines. run_program() calls it.
void begin(const std::string& program);

}  // namespace dance::talk
