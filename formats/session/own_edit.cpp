#include "formats/session/own_edit.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/base/plain_number.h"
#include "formats/session/table_edit.h"
#include "formats/session/toml_places.h"

namespace dance {
namespace {

const TablePlace kOwnHouse{"house", std::nullopt};
const TablePlace kOwnVoice{"voice", std::nullopt};

std::string text_in(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node != nullptr ? node->value_or(std::string()) : std::string();
}

std::vector<std::string> texts_in(const toml::table& table, std::string_view key) {
  std::vector<std::string> texts;
  const toml::node* node = table.get(key);
  const toml::array* array = node != nullptr ? node->as_array() : nullptr;
  if (array == nullptr) return texts;
  for (const toml::node& each : *array) texts.push_back(each.value_or(std::string()));
  return texts;
}

// [[avatar]] of that guest; nullptr = there is none.
const toml::table* avatar_of(const toml::table& document, std::string_view guest,
                             std::size_t& place) {
  for (place = 0;; ++place) {
    const toml::table* table = table_of(document, "avatar", place);
    if (table == nullptr || text_in(*table, "guest") == guest) return table;
  }
}

Result<std::optional<std::size_t>> avatar_place(std::string_view text, std::string_view guest,
                                                const std::string& name) {
  using Place = Result<std::optional<std::size_t>>;
  return with_toml(text, name, [&](const toml::table& document) -> Place {
    std::size_t place = 0;
    if (avatar_of(document, guest, place) == nullptr) return std::nullopt;
    return place;
  });
}

Result<void> check_own(std::string_view text, std::string_view guest, const std::string& name) {
  DANCE_TRY(const auto guests, own_guests(text, name));
  if (std::ranges::find(guests, guest) != guests.end()) return {};
  return fail(name + " has no guest '" + std::string(guest) + "' to keep this for");
}

// The key has that value, or is taken away where that is "".
Result<std::string> put(const Result<std::string>& text, const TablePlace& place, const char* key,
                        const std::string& value, const std::string& name) {
  if (!text) return text;
  return value.empty() ? remove_value(*text, place, key, name)
                       : set_value(*text, place, key, value, name);
}

std::string quoted_or_none(std::string_view text) { return text.empty() ? "" : toml_text(text); }

Result<std::vector<std::string>> listed_names(std::string_view text, const std::string& name) {
  using Names = Result<std::vector<std::string>>;
  return with_toml(text, name, [](const toml::table& document) -> Names {
    const toml::table* house = document["house"].as_table();
    return house != nullptr ? texts_in(*house, "shown_names") : std::vector<std::string>();
  });
}

}  // namespace

Result<std::vector<std::string>> own_guests(std::string_view text, const std::string& name) {
  using Guests = Result<std::vector<std::string>>;
  return with_toml(text, name, [](const toml::table& document) -> Guests {
    std::vector<std::string> guests;
    const toml::table* house = document["house"].as_table();
    if (house == nullptr) return guests;
    if (const std::string first = text_in(*house, "guest"); !first.empty()) guests.push_back(first);
    for (std::string& each : texts_in(*house, "guests")) guests.push_back(std::move(each));
    return guests;
  });
}

Result<OwnFigure> own_figure(std::string_view text, std::string_view guest,
                             const std::string& name) {
  return with_toml(text, name, [&](const toml::table& document) -> Result<OwnFigure> {
    OwnFigure figure;
    std::size_t place = 0;
    const toml::table* table = avatar_of(document, guest, place);
    if (table == nullptr) return figure;
    figure.what = text_in(*table, "name");
    if (const std::string file = text_in(*table, "file"); !file.empty()) {
      figure.what = (std::filesystem::path(name).parent_path() / file).string();
      if (!figure.is_file()) figure.what.insert(0, "./");
    }
    figure.look = text_in(*table, "look");
    figure.colour = text_in(*table, "colour");
    const toml::node* height = table->get("height");
    if (height != nullptr) figure.height = height->value_or(1.0);
    return figure;
  });
}

Result<std::string> set_own_figure(std::string_view text, std::string_view guest,
                                   const OwnFigure& figure, const std::string& name) {
  if (auto checked = check_own(text, guest, name); !checked)
    return tl::make_unexpected(checked.error());
  DANCE_TRY(const auto found, avatar_place(text, guest, name));
  std::string begun(text);
  if (!found) {
    if (figure == OwnFigure()) return begun;
    begun = append_table(text, "avatar", {{"guest", toml_text(guest)}});
  }
  DANCE_TRY(const auto place, avatar_place(begun, guest, name));
  const TablePlace at{"avatar", place};
  Result<std::string> edited(std::move(begun));
  edited = put(edited, at, "name", quoted_or_none(figure.is_file() ? "" : figure.what), name);
  edited = put(edited, at, "file", quoted_or_none(figure.is_file() ? figure.what : ""), name);
  edited = put(edited, at, "look", quoted_or_none(figure.look), name);
  edited = put(edited, at, "colour", quoted_or_none(figure.colour), name);
  const std::string height = figure.height == 1.0 ? "" : plain_number(figure.height);
  DANCE_TRY(const OwnFigure before, own_figure(text, guest, name));
  // An equal number in another notation stays as it was written.
  return before.height == figure.height ? edited : put(edited, at, "height", height, name);
}

Result<std::string> set_own_name(std::string_view text, std::string_view guest,
                                 std::string_view shown_name, const std::string& name) {
  if (auto checked = check_own(text, guest, name); !checked)
    return tl::make_unexpected(checked.error());
  DANCE_TRY(const auto guests, own_guests(text, name));
  DANCE_TRY(const auto listed, listed_names(text, name));
  const bool is_first = guests.front() == guest;
  const std::string begin = std::string(guest) + "=";
  std::vector<std::string> names = listed;
  std::erase_if(names, [&](const std::string& each) { return each.starts_with(begin); });
  if (!is_first && !shown_name.empty()) names.push_back(begin + std::string(shown_name));
  Result<std::string> edited{std::string(text)};
  if (is_first) edited = put(edited, kOwnHouse, "shown_name", quoted_or_none(shown_name), name);
  // An unchanged list stays as it was written.
  if (names == listed) return edited;
  return put(edited, kOwnHouse, "shown_names", names.empty() ? "" : toml_texts(names), name);
}

Result<std::string> set_own_voice(std::string_view text, bool is_enabled, const std::string& name) {
  DANCE_TRY(const auto guests, own_guests(text, name));
  DANCE_TRY(const auto tables, table_names(text, name));
  const bool has_voice = std::ranges::find(tables, kOwnVoice.table) != tables.end();
  if (guests.empty() && !has_voice) return fail(name + " has no guest who could speak");
  if (!is_enabled) return set_value(text, kOwnVoice, "enabled", "false", name);
  return has_voice ? remove_value(text, kOwnVoice, "enabled", name)
                   : set_value(text, kOwnVoice, "enabled", "true", name);
}

}  // namespace dance
