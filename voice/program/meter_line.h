// MeterLine: one line of levels that is written over and over at the foot of a terminal, never
// longer than the terminal is wide. What else is said first takes it away.
//
// Units/frames: columns of the terminal; each character of the text takes one.
// Ownership:    refers to a file descriptor.
// Threads:      none inside.
// Failure:      a terminal that does not know its width counts as 80 columns.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dance {

// The first characters (of UTF-8, each one column wide) of a text; of one that is cut the last is
// an ellipsis.
std::string cut_to_columns(std::string_view text, std::size_t columns);

class MeterLine {
 public:
  explicit MeterLine(int fd) : fd_(fd) {}

  void show(std::string_view text);
  void clear();

 private:
  std::size_t columns() const;
  void write(std::string_view text) const;

  int fd_;
  bool is_shown_ = false;
};

}  // namespace dance
