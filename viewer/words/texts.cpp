#include "viewer/words/texts.h"

#include <array>

namespace dance {
namespace {

struct TextRow {
  std::array<const char*, kLanguages.size()> in;
};

#define DANCE_TEXT_ROW(name, ...) TextRow{{__VA_ARGS__}},
// The size is given, because clang deduces it for 256 rows at most.
constexpr std::array<TextRow, static_cast<std::size_t>(Text::kCount)> kTextRows{
    {DANCE_TEXTS(DANCE_TEXT_ROW)}};
#undef DANCE_TEXT_ROW

constexpr bool every_text_is_there() {
  for (const TextRow& row : kTextRows)
    for (const char* text : row.in)
      if (text == nullptr || *text == '\0') return false;
  return true;
}
static_assert(every_text_is_there(), "a row lacks a language");

}  // namespace

const char* Texts::operator[](Text text) const {
  return kTextRows[static_cast<std::size_t>(text)].in[static_cast<std::size_t>(language_)];
}

std::string Texts::say(Text text, std::initializer_list<std::string_view> values) const {
  std::string_view rest = (*this)[text];
  std::string said;
  for (const std::string_view value : values) {
    const std::size_t place = rest.find("{}");
    if (place == std::string_view::npos) break;
    said.append(rest.substr(0, place)).append(value);
    rest.remove_prefix(place + 2);
  }
  return said.append(rest);
}

}  // namespace dance
