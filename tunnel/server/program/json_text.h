// JSON on one line, written in one go.
//
// Units/frames: numbers to a thousandth.
// Ownership:    owns its text.
// Threads:      none inside.
// Failure:      characters that JSON would escape become '?'.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.h"

namespace dance {

inline std::optional<double> ms_of(const std::optional<Duration>& duration) {
  return duration ? std::optional(duration->as_ms()) : std::nullopt;
}

// {"a":1,"b":[…]}: members and elements in the order in which they are written.
class StatusJsonText {
 public:
  void open(char bracket) {
    out_ += bracket;
    is_first_ = true;
  }
  void close(char bracket) {
    out_ += bracket;
    is_first_ = false;
  }
  // Before each element of a list.
  void next() {
    if (!is_first_) out_ += ',';
    is_first_ = false;
  }
  void key(std::string_view name) {
    next();
    text(name);
    out_ += ':';
  }
  // Names and addresses: what would need to be escaped does not belong there.
  void text(std::string_view value) {
    out_ += '"';
    for (const char c : value) out_ += c < ' ' || c > '~' || c == '"' || c == '\\' ? '?' : c;
    out_ += '"';
  }
  void member(std::string_view name, std::string_view value) {
    key(name);
    text(value);
  }
  // A value that is plain text already (core/base/text/plain_text.h), in UTF-8.
  void plain_member(std::string_view name, std::string_view value) {
    key(name);
    out_ += '"';
    for (const char c : value) {
      if (c == '"' || c == '\\') out_ += '\\';
      out_ += c;
    }
    out_ += '"';
  }
  void member(std::string_view name, std::uint64_t value) {
    key(name);
    fmt::format_to(std::back_inserter(out_), "{}", value);
  }
  // To a thousandth.
  void member(std::string_view name, double value) {
    key(name);
    fmt::format_to(std::back_inserter(out_), "{:.3f}", value);
  }
  void member(std::string_view name, const std::optional<double>& value) {
    if (value) return member(name, *value);
    key(name);
    out_ += "null";
  }
  template <class Count>
  void member(std::string_view name, const std::vector<Count>& counts) {
    key(name);
    open('{');
    for (const Count& count : counts) member(count.name, count.count);
    close('}');
  }
  void flag(std::string_view name, bool value) {
    key(name);
    out_ += value ? "true" : "false";
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
  bool is_first_ = true;
};

}  // namespace dance
