// A short string of bounded length with inline storage: for guest ids and channel names on the pose
// path, where std::string could allocate.
//
// Ownership: holds its characters; always NUL-terminated.
// Threads:   none inside; plain value.
// Failure:   assign() of a longer text is refused (false) and leaves the string as it was.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <string_view>

namespace dance {

template <std::size_t kCapacity>
class FixedString {
 public:
  constexpr FixedString() = default;

  [[nodiscard]] bool assign(std::string_view text) {
    if (text.size() > kCapacity) return false;
    std::copy(text.begin(), text.end(), chars_.begin());
    chars_[text.size()] = '\0';
    size_ = text.size();
    return true;
  }

  std::string_view view() const { return {chars_.data(), size_}; }
  const char* c_str() const { return chars_.data(); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool operator==(const FixedString& o) const { return view() == o.view(); }
  auto operator<=>(const FixedString& o) const { return view() <=> o.view(); }
  bool operator==(std::string_view o) const { return view() == o; }

 private:
  std::array<char, kCapacity + 1> chars_{};
  std::size_t size_ = 0;
};

}  // namespace dance
