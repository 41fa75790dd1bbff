// JsonText: JSON put together in a buffer that is used again, numbers with a point whatever the
// locale.
//
// Units/frames: floats as the shortest text that reads back as the same float.
// Ownership:    holds its characters; allocates where a text is longer than all before.
// Threads:      none inside; one owner.
// Failure:      numbers must be finite, and texts free of quotes and control characters: what is
//               written are names of ours and checked values.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

namespace dance {

class JsonText {
 public:
  explicit JsonText(std::size_t room_bytes) { text_.reserve(room_bytes); }

  void clear() { text_.clear(); }
  std::string_view view() const { return text_; }

  JsonText& raw(std::string_view json) {
    text_ += json;
    return *this;
  }
  template <class Number>
  requires(std::floating_point<Number> || std::integral<Number>) JsonText& number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text_.append(digits.data(), end.ptr);
    return *this;
  }
  JsonText& quoted(std::string_view text) {
    text_ += '"';
    text_ += text;
    text_ += '"';
    return *this;
  }
  // {"x":1,"y":2,"z":3}
  JsonText& xyz(float x, float y, float z) {
    return raw("{\"x\":").number(x).raw(",\"y\":").number(y).raw(",\"z\":").number(z).raw("}");
  }
  JsonText& xyzw(float x, float y, float z, float w) {
    raw("{\"x\":").number(x).raw(",\"y\":").number(y).raw(",\"z\":").number(z);
    return raw(",\"w\":").number(w).raw("}");
  }
  // A Foxglove time, which is not negative.
  JsonText& time(std::uint64_t ns) {
    raw("{\"sec\":").number(ns / 1'000'000'000u);
    return raw(",\"nsec\":").number(ns % 1'000'000'000u).raw("}");
  }

 private:
  std::string text_;
};

}  // namespace dance
