// The name of a dancer in a room: 1 to 24 characters of a–z, 0–9 and '-'. The only definition of a
// valid guest id.
//
// Ownership: plain value, no allocation.
// Threads:   none inside.
// Failure:   parse() returns nullopt for anything else.
#pragma once

#include <optional>
#include <string_view>

#include "core/base/fixed_string.h"

namespace dance {

constexpr std::size_t kMaxGuestIdLength = 24;

class GuestId {
 public:
  GuestId() = default;  // not set

  static std::optional<GuestId> parse(std::string_view text) {
    if (text.empty() || text.size() > kMaxGuestIdLength) return std::nullopt;
    for (const char c : text) {
      const bool allowed = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
      if (!allowed) return std::nullopt;
    }
    GuestId id;
    return id.text_.assign(text) ? std::optional(id) : std::nullopt;
  }

  std::string_view view() const { return text_.view(); }
  const char* c_str() const { return text_.c_str(); }
  bool is_set() const { return !text_.empty(); }
  bool operator==(const GuestId&) const = default;
  auto operator<=>(const GuestId& o) const { return text_ <=> o.text_; }

 private:
  FixedString<kMaxGuestIdLength> text_;
};

// The error message for a text that parse() refused.
constexpr const char* kGuestIdRule = "a guest id is 1 to 24 characters of a-z, 0-9 and '-'";

}  // namespace dance
