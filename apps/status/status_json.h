// What the tables of `dance status` read of a server's JSON, which may be of another version, or
// another program's.
//
// Units/frames: as the JSON says.
// Ownership:    views of the JSON.
// Threads:      none inside.
// Failure:      what is missing or of another kind is nothing; texts are short and printable.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/base/text/cut_text.h"
#include "core/base/text/plain_text.h"

namespace dance::status_json {

using json = nlohmann::ordered_json;

inline const json& member(const json& object, const char* key) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

inline std::optional<double> number(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

// Names are untrusted: control characters do not reach the terminal.
inline std::string text(const json& object, const char* key) {
  const json& value = member(object, key);
  std::string out = value.is_string() ? value.get<std::string>().substr(0, 48) : "-";
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

// Returns a shown name of any script; characters that control the terminal are replaced.
inline std::string shown_text(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_string() ? plain_text(cut_text(value.get<std::string>(), 48)) : "-";
}

inline std::string cell(std::optional<double> value, double scale, int digits, const char* unit) {
  return value ? fmt::format("{:.{}f}{}", *value * scale, digits, unit) : std::string("-");
}

// The objects of a list; none where there is no list.
template <class Do>
void each(const json& list, Do act) {
  if (!list.is_array()) return;
  for (const json& entry : list) act(entry);
}

// Only what has happened.
inline void add_causes(const char* title, const json& causes, std::string& out) {
  if (!causes.is_object()) return;
  std::string line;
  for (const auto& [name, count] : causes.items()) {
    if (!count.is_number() || count.get<double>() == 0.0) continue;
    line += fmt::format("  {} {:.0f}", text(json{{"name", name}}, "name"), count.get<double>());
  }
  if (!line.empty()) out += std::string("\n") + title + ":" + line + "\n";
}

}  // namespace dance::status_json
