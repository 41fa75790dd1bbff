// MessageThrottle: limits repeated messages: a new line is due at once, the same one once a minute.
//
// Units/frames: times of the monotonic clock.
// Ownership:    keeps copies of the last kMost lines.
// Threads:      none inside; one owner.
// Failure:      none; the oldest line is evicted when there are more, and is new again.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "core/program/talk.h"

namespace dance {

class MessageThrottle {
 public:
  bool is_due(const std::string& line, MonoTime now) {
    for (Said& said : said_) {
      if (said.line != line) continue;
      if (now - said.time < kAgain) return false;
      said.time = now;
      return true;
    }
    if (said_.size() == kMost) said_.erase(said_.begin());
    said_.push_back({line, now});
    return true;
  }
  void warn(const std::string& line, MonoTime now) {
    if (is_due(line, now)) talk::warn("{}", line);
  }
  // The trouble is over: the next line is new.
  void forget() { said_.clear(); }

 private:
  static constexpr Duration kAgain = Duration::s(60);
  static constexpr std::size_t kMost = 8;
  struct Said {
    std::string line;
    MonoTime time;
  };
  std::vector<Said> said_;
};

}  // namespace dance
