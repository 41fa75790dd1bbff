#include "formats/session/toml_places.h"

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

}  // namespace dance
