#include "core/bus/channel_pattern.h"

#include <array>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::string_view kGuestWord = "/guest/";

bool is_name_character(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == '-';
}

bool has_only_words(std::string_view text) {
  char before = '/';
  for (const char c : text) {
    if (c == '/' ? before == '/' : !is_name_character(c)) return false;
    before = c;
  }
  return true;
}

std::string_view first_word(std::string_view text) { return text.substr(0, text.find('/')); }

// PACKED is what packed logs put in front of our channels.
bool is_own_signal(std::string_view word) {
  if (word == "PACKED") return true;
  for (const ChannelRow& row : kChannelTable)
    if (first_word(row.pattern) == word) return true;
  return false;
}

}  // namespace

bool is_foreign_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxForeignName && name.back() != '/' &&
         has_only_words(name) && !is_own_signal(first_word(name)) &&
         name.find(kGuestWord) == std::string_view::npos && !name.ends_with("/guest");
}

FixedString<kMaxChannelLength> name_of_guest(std::string_view name, const GuestId& guest) {
  DANCE_ASSERT(is_foreign_name(name) && guest.is_set());
  std::array<char, kMaxChannelLength> chars{};
  std::size_t size = 0;
  for (const std::string_view part : {name, kGuestWord, guest.view()})
    for (const char c : part) chars[size++] = c;
  FixedString<kMaxChannelLength> whole;
  [[maybe_unused]] const bool fits = whole.assign({chars.data(), size});
  return whole;
}

Result<ChannelPattern> ChannelPattern::parse(std::string_view text) {
  const auto wrong = [&](const std::string& why) {
    return fail("channel \"" + std::string(text.substr(0, 80)) + "\": " + why);
  };
  ChannelPattern pattern;
  pattern.is_prefix_ = text.ends_with('*');
  const std::string_view name = pattern.is_prefix_ ? text.substr(0, text.size() - 1) : text;
  if (name.empty()) return wrong("say which channel, as LIGHT/desk or LIGHT/*");
  if (name.size() > kMaxForeignName)
    return wrong("at most " + std::to_string(kMaxForeignName) +
                 " characters, as \"/guest/\" and a guest come behind it");
  if (!has_only_words(name))
    return wrong("words of A-Z a-z 0-9 _ . - between single slashes, and * only at the end");
  if (is_own_signal(first_word(name)))
    return wrong(std::string(first_word(name)) + " is one of dance's own signals; choose another");
  if (!pattern.is_prefix_ && !is_foreign_name(name))
    return wrong(
        "no slash at the end, and no word \"guest\" in it: what has come from another "
        "house is called so");
  if (pattern.is_prefix_ && name.find(kGuestWord) != std::string_view::npos)
    return wrong("no word \"guest\" in it: what has come from another house is called so");
  // A beginning as "PO*" would mean our own signals as well.
  if (pattern.is_prefix_ && name.find('/') == std::string_view::npos)
    return wrong("a whole first word before the *, as LIGHT/*");
  [[maybe_unused]] const bool fits = pattern.text_.assign(text);
  return pattern;
}

bool ChannelPattern::matches(std::string_view name) const {
  if (!is_foreign_name(name)) return false;
  const std::string_view own = text_.view();
  return is_prefix_ ? name.starts_with(own.substr(0, own.size() - 1)) : name == own;
}

}  // namespace dance
