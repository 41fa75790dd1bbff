// LineBuilder: a line of text put together in a buffer of its own, numbers with a point whatever
// the locale.
//
// Ownership: holds its characters; never allocates.
// Threads:   none inside; one owner.
// Failure:   a line longer than the buffer is our bug.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <string_view>

#include "core/base/assert.h"

namespace dance {

class LineBuilder {
 public:
  void clear() { size_ = 0; }
  std::string_view view() const { return {chars_.data(), size_}; }

  void text(std::string_view t) {
    DANCE_ASSERT(size_ + t.size() <= chars_.size(), size_, t.size());
    for (const char c : t) chars_[size_++] = c;
  }
  void integer(std::integral auto value) {
    took(std::to_chars(end(), chars_.data() + chars_.size(), value));
  }
  // The shortest text that reads back as the same float; nothing where there is no number.
  void number(std::floating_point auto value) {
    if (std::isfinite(value)) took(std::to_chars(end(), chars_.data() + chars_.size(), value));
  }
  void fixed(double value, int decimals) {
    took(std::to_chars(end(), chars_.data() + chars_.size(), value, std::chars_format::fixed,
                       decimals));
  }

 private:
  char* end() { return chars_.data() + size_; }
  void took(std::to_chars_result result) {
    DANCE_ASSERT(result.ec == std::errc(), size_);
    size_ = static_cast<std::size_t>(result.ptr - chars_.data());
  }

  std::array<char, 4096> chars_;
  std::size_t size_ = 0;
};

}  // namespace dance
