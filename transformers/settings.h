// The settings of a station as people write them in a route: "rhythm beats=1 strength=0.5". Each is
// a name, =, and a value; what is not written keeps the value that it had.
//
// Units/frames: durations carry their unit, as "20ms".
// Ownership:    refers to the texts, which must outlive it.
// Threads:      none inside.
// Failure:      done() names the first setting that is wrong, and what would be right.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

// "20ms", "1.5s", "800us": a length of time as people write it.
Result<Duration> parse_duration(std::string_view text);

class Settings {
 public:
  Settings(std::string_view station, std::span<const std::string_view> arguments);

  Settings& number(std::string_view name, double& value, double least, double most);
  // A number, or a word that stands for one.
  Settings& number_or(std::string_view name, std::string_view word, double word_value,
                      double& value, double least, double most);
  Settings& duration(std::string_view name, Duration& value, Duration least, Duration most);
  // 0 or 1.
  Settings& flag(std::string_view name, bool& value);
  Settings& text(std::string_view name, std::string& value);
  // Whether the names were all asked for, and their values right.
  Result<void> done() const;

 private:
  struct Given {
    std::string_view name, value;
    bool asked = false;
  };
  // The value of a name that is given, else null; notes the name as one that there is.
  const std::string_view* find(std::string_view name, std::string_view takes);
  void refuse(std::string_view name, std::string_view value, const std::string& takes);

  std::string station_;
  std::vector<Given> given_;
  std::string known_, trouble_;
};

}  // namespace dance
