#include "formats/session/toml_places.h"

#include <algorithm>

#include "core/base/text/cut_text.h"
#include "core/base/text/plain_text.h"

namespace dance {

std::size_t line_begin(std::string_view text, toml::source_index line) {
  std::size_t at = 0;
  for (toml::source_index i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return text.size();
    at = end + 1;
  }
  return at;
}

// Columns count characters, not bytes.
std::size_t offset_of(std::string_view text, const toml::source_position& place) {
  std::size_t at = line_begin(text, place.line);
  for (toml::source_index column = 1; column < place.column && at < text.size(); ++column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0u) == 0x80u) ++at;
  }
  return at;
}

const toml::table* table_of(const toml::table& document, std::string_view key, std::size_t place) {
  const toml::node* node = document.get(key);
  const toml::array* array = node ? node->as_array() : nullptr;
  return array && place < array->size() ? array->get(place)->as_table() : nullptr;
}

Error error_at(const std::string& name, const toml::source_region& source,
               const std::string& what) {
  return {name + ":" + std::to_string(source.begin.line) + ":" +
          std::to_string(source.begin.column) + ": " + what};
}

Error syntax_error(const std::string& name, std::string_view text, const toml::parse_error& error) {
  constexpr std::size_t kLongestQuote = 60;
  const toml::source_region& source = error.source();
  const std::string_view described = error.description();
  const std::size_t begin = line_begin(text, source.begin.line);
  std::string_view line = text.substr(begin, text.substr(begin).find_first_of("\r\n"));
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (described.find("UTF-8") != described.npos || described.find("utf-8") != described.npos)
    return error_at(name, source, "this is no text in UTF-8; save the file as UTF-8");
  if (described.find("redefine") != described.npos)
    return error_at(name, source, "this name is there already; keep one of the two");
  if (offset_of(text, source.begin) >= text.size())
    return error_at(name, source,
                    "the file ends within a value; close its quote or bracket, and write a value "
                    "behind each =");
  return error_at(name, source,
                  "no TOML can be read from here on in '" +
                      plain_text(cut_text(line, kLongestQuote)) +
                      "'; write NAME = VALUE, and texts in quotes");
}

}  // namespace dance
