// Formats counts of reading or writing for a user: "3 rows, 2 lines".
//
// Units/frames: none.
// Ownership:    returns a new text.
// Threads:      any.
// Failure:      none; "" where all counts are 0.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace dance {

struct Counted {
  std::uint64_t count;
  std::string_view what;
};

inline std::string listed(std::initializer_list<Counted> all) {
  std::string text;
  for (const auto& [count, what] : all) {
    if (count == 0) continue;
    if (!text.empty()) text += ", ";
    text += std::to_string(count) + " " + std::string(what);
  }
  return text;
}

}  // namespace dance
