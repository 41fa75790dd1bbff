#include "formats/session/table_edit.h"

#include <algorithm>

#include "formats/session/toml_places.h"

namespace dance {
namespace {

std::size_t after_line(std::string_view text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string_view::npos ? text.size() : end + 1;
}

// One past the last byte of the string that begins at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string triple(3, quote);
  const bool is_long = text.substr(at, 3) == triple;
  for (std::size_t i = at + (is_long ? 3 : 1); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (is_long && text.substr(i, 3) == triple) {
      i += 3;
      while (i < text.size() && text[i] == quote) ++i;  // two more may belong to it
      return i;
    } else if (!is_long && text[i] == quote) {
      return i + 1;
    }
  }
  return text.size();
}

// Of a value of any kind that begins at `at`; the text is known to be TOML.
std::size_t end_of_value(std::string_view text, std::size_t at) {
  int depth = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end_of_string(text, at);
      if (depth == 0) return at;
      continue;
    }
    if (c == '#' && depth > 0) {
      at = after_line(text, at);
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') {
      if (--depth == 0) return at + 1;
      if (depth < 0) return at;
    }
    if (depth == 0 && (c == '#' || c == '\n' || c == '\r' || c == ',')) break;
    ++at;
  }
  while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\t')) --at;
  return at;
}

const toml::table* find_table(const toml::table& document, const TablePlace& place) {
  if (place.index) return table_of(document, place.table, *place.index);
  const toml::node* node = document.get(place.table);
  return node ? node->as_table() : nullptr;
}

std::string heading(const TablePlace& place) {
  return place.index ? "[[" + place.table + "]]" : "[" + place.table + "]";
}

// Its heading stands on a line of its own.
Result<void> check_heading(std::string_view text, const toml::table& table, const TablePlace& place,
                           const std::string& name) {
  const std::size_t at = offset_of(text, table.source().begin);
  if (table.is_inline() || at >= text.size() || text[at] != '[')
    return tl::make_unexpected(
        error_at(name, table.source(), "write " + heading(place) + " on a line of its own"));
  return {};
}

// Where a new key of the table goes: after the last that it has.
std::size_t end_of_keys(std::string_view text, const toml::table& table) {
  std::size_t end = after_line(text, offset_of(text, table.source().begin));
  for (const auto& [key, node] : table) {
    if (node.is_table() && !node.as_table()->is_inline()) continue;
    if (node.is_array_of_tables() && text[offset_of(text, node.source().begin)] == '[' &&
        text.substr(line_begin(text, node.source().begin.line), 2) == "[[")
      continue;
    const std::size_t value = offset_of(text, node.source().begin);
    end = std::max(end, after_line(text, end_of_value(text, value)));
  }
  return end;
}

void note_headings(const toml::table& table, std::vector<toml::source_index>& lines) {
  for (const auto& [key, node] : table) {
    if (const toml::table* inner = node.as_table()) {
      if (inner->is_inline()) continue;
      lines.push_back(inner->source().begin.line);
      note_headings(*inner, lines);
    } else if (const toml::array* array = node.as_array(); array && array->is_array_of_tables()) {
      for (const toml::node& element : *array) {
        if (element.as_table()->is_inline()) continue;
        lines.push_back(element.source().begin.line);
        note_headings(*element.as_table(), lines);
      }
    }
  }
}

}  // namespace

std::string toml_text(std::string_view text) {
  constexpr const char* kHex = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string toml_texts(const std::vector<std::string>& texts) {
  std::string out = "[";
  for (const std::string& text : texts) out += (out.size() > 1 ? ", " : "") + toml_text(text);
  return out + "]";
}

Result<std::string> set_value(std::string_view text, const TablePlace& place, std::string_view key,
                              std::string_view value, const std::string& name) {
  return with_toml(text, name, [&](const toml::table& document) -> Result<std::string> {
    std::string out(text);
    const toml::table* table = find_table(document, place);
    const std::string line = std::string(key) + " = " + std::string(value) + "\n";
    if (!table) {
      if (place.index) return fail(name + " has no " + heading(place) + " of that number");
      if (!out.empty() && out.back() != '\n') out += '\n';
      return out + (out.empty() ? "" : "\n") + heading(place) + "\n" + line;
    }
    if (const toml::node* node = table->get(key)) {
      const std::size_t begin = offset_of(text, node->source().begin);
      return out.replace(begin, end_of_value(text, begin) - begin, value);
    }
    if (auto checked = check_heading(text, *table, place, name); !checked)
      return tl::make_unexpected(checked.error());
    const std::size_t end = end_of_keys(text, *table);
    const bool needs_break = end > 0 && text[end - 1] != '\n';
    return out.insert(end, (needs_break ? "\n" : "") + line);
  });
}

Result<std::string> remove_value(std::string_view text, const TablePlace& place,
                                 std::string_view key, const std::string& name) {
  return with_toml(text, name, [&](const toml::table& document) -> Result<std::string> {
    std::string out(text);
    const toml::table* table = find_table(document, place);
    const toml::node* node = table ? table->get(key) : nullptr;
    if (!node) return out;
    if (auto checked = check_heading(text, *table, place, name); !checked)
      return tl::make_unexpected(checked.error());
    const std::size_t value = offset_of(text, node->source().begin);
    const std::size_t begin = line_begin(text, node->source().begin.line);
    return out.erase(begin, after_line(text, end_of_value(text, value)) - begin);
  });
}

std::string append_table(std::string_view text, std::string_view table,
                         const std::vector<std::pair<std::string, std::string>>& values) {
  std::string out(text);
  if (!out.empty() && out.back() != '\n') out += '\n';
  out += (out.empty() ? "[[" : "\n[[") + std::string(table) + "]]\n";
  for (const auto& [key, value] : values) {
    out += key;
    out += " = " + value + "\n";
  }
  return out;
}

Result<std::string> remove_table(std::string_view text, const TablePlace& place,
                                 const std::string& name) {
  return with_toml(text, name, [&](const toml::table& document) -> Result<std::string> {
    std::string out(text);
    const toml::table* table = find_table(document, place);
    if (!table) return out;
    if (auto checked = check_heading(text, *table, place, name); !checked)
      return tl::make_unexpected(checked.error());
    std::vector<toml::source_index> lines;
    note_headings(document, lines);
    const toml::source_index first = table->source().begin.line;
    std::size_t end = text.size();
    for (const toml::source_index line : lines)
      if (line > first) end = std::min(end, line_begin(text, line));
    // The comment of the next heading stays with it.
    while (end < text.size() && end > 1) {
      const std::size_t before = text.rfind('\n', end - 2);
      const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
      if (text[begin] != '#' || begin <= line_begin(text, first)) break;
      end = begin;
    }
    const std::size_t begin = line_begin(text, first);
    return out.erase(begin, end - begin);
  });
}

Result<std::vector<std::map<std::string, std::string>>> texts_of_tables(std::string_view text,
                                                                        std::string_view table,
                                                                        const std::string& name) {
  using Tables = std::vector<std::map<std::string, std::string>>;
  return with_toml(text, name, [&](const toml::table& document) -> Result<Tables> {
    Tables found;
    const auto add = [&](const toml::table& from) {
      auto& texts = found.emplace_back();
      for (const auto& [key, node] : from)
        if (const auto value = node.value_exact<std::string>())
          texts.emplace(std::string(key.str()), *value);
    };
    const toml::node* node = document.get(table);
    if (node && node->is_table()) add(*node->as_table());
    if (node && node->is_array_of_tables())
      for (const toml::node& element : *node->as_array()) add(*element.as_table());
    return found;
  });
}

Result<std::vector<std::string>> table_names(std::string_view text, const std::string& name) {
  return with_toml(text, name, [](const toml::table& document) -> Result<std::vector<std::string>> {
    std::vector<std::string> names;
    for (const auto& [key, node] : document) names.emplace_back(key.str());
    return names;
  });
}

}  // namespace dance
