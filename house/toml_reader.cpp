#include "house/toml_reader.h"

#include <algorithm>

#include "core/base/plain_number.h"
#include "core/base/text/guest_id_hint.h"

namespace dance {

TomlReader::TomlReader(const toml::table& table, std::string file, std::string what)
    : table_(table), file_(std::move(file)), what_(std::move(what)) {}

std::string TomlReader::place(const toml::source_region& source) const {
  return file_ + ":" + std::to_string(source.begin.line) + ":" +
         std::to_string(source.begin.column) + ": ";
}

void TomlReader::complain_at(const toml::source_region& source, const std::string& what) {
  if (!problem_) problem_ = Error{place(source) + what};
}

void TomlReader::complain(std::string_view key, const std::string& what) {
  const toml::node* node = table_.get(key);
  complain_at(node ? node->source() : table_.source(),
              what_ + " " + std::string(key) + ": " + what);
}

const toml::node* TomlReader::take(std::string_view key) {
  asked_.emplace_back(key);
  return table_.get(key);
}

std::optional<std::string> TomlReader::maybe_string(std::string_view key) {
  const toml::node* node = take(key);
  if (!node) return std::nullopt;
  if (const auto value = node->value_exact<std::string>()) return *value;
  complain(key, "takes a text in quotes");
  return std::nullopt;
}

std::string TomlReader::string_or(std::string_view key, std::string fallback) {
  return maybe_string(key).value_or(std::move(fallback));
}

std::string TomlReader::required_string(std::string_view key) {
  const auto value = maybe_string(key);
  if (!value) complain(key, "is missing");
  return value.value_or("");
}

double TomlReader::number_or(std::string_view key, double fallback, double low, double high) {
  const toml::node* node = take(key);
  if (!node) return fallback;
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (value && *value >= low && *value <= high) return *value;
  complain(key, "takes a number from " + plain_number(low) + " to " + plain_number(high));
  return fallback;
}

std::int64_t TomlReader::integer_or(std::string_view key, std::int64_t fallback, std::int64_t low,
                                    std::int64_t high) {
  const toml::node* node = take(key);
  if (!node) return fallback;
  const auto value = node->value_exact<std::int64_t>();
  if (value && *value >= low && *value <= high) return *value;
  complain(key, "takes a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return fallback;
}

bool TomlReader::bool_or(std::string_view key, bool fallback) {
  const toml::node* node = take(key);
  if (!node) return fallback;
  if (const auto value = node->value_exact<bool>()) return *value;
  complain(key, "takes true or false");
  return fallback;
}

std::vector<std::string> TomlReader::strings(std::string_view key, const std::string& example) {
  std::vector<std::string> values;
  const toml::node* node = take(key);
  if (!node) return values;
  const toml::array* array = node->as_array();
  if (!array) {
    complain(key, "takes a list of texts, like " + example);
    return values;
  }
  for (const toml::node& element : *array) {
    const auto value = element.value_exact<std::string>();
    if (!value) {
      complain_at(element.source(), what_ + " " + std::string(key) + ": takes texts in quotes");
      return {};
    }
    values.push_back(*value);
  }
  return values;
}

void TomlReader::finish() {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (std::find(asked_.begin(), asked_.end(), name) != asked_.end()) continue;
    std::string known;
    for (const std::string& asked : asked_) known += (known.empty() ? "" : ", ") + asked;
    complain_at(key.source(), what_ + " has no key '" + name + "'; it has: " + known);
  }
}

GuestId read_guest(TomlReader& reader, std::string_view key, const std::string& text) {
  const auto id = GuestId::parse(text);
  if (!id) reader.complain(key, guest_id_error(text));
  return id.value_or(GuestId());
}

}  // namespace dance
