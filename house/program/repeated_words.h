// RepeatedWords: of a program that is started again and again, which of its lines are to be shown:
// not those that its last start ended with as well.
//
// Units/frames: lines without their ends; the time at the start of a line does not count.
// Ownership:    plain value; keeps kMostLines of a start.
// Threads:      none inside.
// Failure:      of a start with more lines the later ones are shown each time.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/program/talk.h"

namespace dance {

class RepeatedWords {
 public:
  static constexpr std::size_t kMostLines = 16;

  // The lines that follow are of another start.
  void start() { before_ = std::exchange(now_, {}); }
  // What was said counts no more: it worked meanwhile.
  void forget() { before_.clear(), now_.clear(); }
  bool is_new(std::string_view line) {
    const std::string words(talk::without_time(line));
    const bool was_said = std::find(before_.begin(), before_.end(), words) != before_.end();
    if (now_.size() < kMostLines) now_.push_back(words);
    return !was_said;
  }

 private:
  std::vector<std::string> before_, now_;
};

}  // namespace dance
