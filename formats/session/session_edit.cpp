#include "formats/session/session_edit.h"

#include <algorithm>
#include <cmath>

#include "core/base/plain_number.h"
#include "formats/session/table_edit.h"
#include "formats/session/toml_places.h"

namespace dance {
namespace {

// The text between two places of the file, and what is to stand there.
struct Replacement {
  std::size_t begin, size;
  std::string text;
};

std::string_view first_word(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  return text.substr(begin, text.find(' ', begin) - begin);
}

// A value that stands on one line, as strings in quotes do: where it ends, toml++ 2 tells of the
// last character or of the one after it, so the closing quote is looked for.
std::optional<Replacement> string_at(std::string_view text, const toml::node& node,
                                     std::string replacement) {
  const std::size_t begin = offset_of(text, node.source().begin);
  if (begin >= text.size() || (text[begin] != '"' && text[begin] != '\'')) return std::nullopt;
  const char quote = text[begin];
  if (text.substr(begin, 3) == std::string(3, quote)) return std::nullopt;
  std::size_t end = begin + 1;
  while (end < text.size() && text[end] != quote && text[end] != '\n') {
    if (quote == '"' && text[end] == '\\') ++end;
    ++end;
  }
  if (end >= text.size() || text[end] != quote) return std::nullopt;
  return Replacement{begin, end + 1 - begin, std::move(replacement)};
}

Result<void> edit_words(std::string_view text, const toml::table& route, const SessionEdit& edit,
                        const std::string& name, std::vector<Replacement>& replacements) {
  const toml::node* through = route.get("through");
  const toml::array* words = through ? through->as_array() : nullptr;
  if (!words)
    return tl::make_unexpected(
        error_at(name, route.source(), "this [[route]] has no list 'through'; write it there"));
  for (const WordEdit& wanted : edit.words) {
    const auto is_it = [&](const toml::node& node) {
      const auto value = node.value_exact<std::string>();
      return value && first_word(*value) == wanted.word;
    };
    const auto found = std::find_if(words->begin(), words->end(), is_it);
    if (found == words->end())
      return tl::make_unexpected(
          error_at(name, words->source(),
                   "'" + wanted.word + "' does not stand in this list; open the house anew"));
    if (*found->value_exact<std::string>() == wanted.text) continue;
    auto replacement = string_at(text, *found, toml_text(wanted.text));
    if (!replacement)
      return tl::make_unexpected(
          error_at(name, found->source(), "write '" + wanted.word + "' in quotes on one line"));
    replacements.push_back(std::move(*replacement));
  }
  return {};
}

void append_style(const StyleEdit& style, std::string& text) {
  if (!text.empty() && text.back() != '\n') text += '\n';
  text += "\n[[style]]\nguest = " + toml_text(style.guest) + "\nwords = " + toml_text(style.words) +
          "\n";
}

void append_routes(const SessionEdit& edit, std::string& text) {
  if (!text.empty() && text.back() != '\n') text += '\n';
  const std::vector<RouteText> routes = usual_routes();
  for (std::size_t i = 0; i < routes.size(); ++i) {
    const RouteText& route = routes[i];
    text += "\n[[route]]\nfrom    = " + toml_text(route.from) + "\n";
    std::string words;
    for (const std::string& usual : route.through) {
      std::string word = usual;
      for (const WordEdit& wanted : edit.words)
        if (i == edit.route && first_word(usual) == wanted.word) word = wanted.text;
      words += (words.empty() ? "" : ", ") + toml_text(word);
    }
    if (!words.empty()) text += "through = [" + words + "]\n";
    text += "to      = " + toml_text(route.to) + "\n";
    if (route.rate_hz > 0.0) text += "rate    = " + plain_number(route.rate_hz) + "\n";
  }
}

// nullptr where there is no such table.
const toml::table* style_of(const toml::table& document, std::string_view whose) {
  for (std::size_t i = 0;; ++i) {
    const toml::table* table = table_of(document, "style", i);
    if (!table) return nullptr;
    const toml::node* guest = table->get("guest");
    if (guest && guest->value_or(std::string()) == whose) return table;
  }
}

// The values of [[style]] of that guest; false where there is no such table.
Result<bool> edit_style(std::string_view text, const toml::table& document, const StyleEdit& style,
                        const std::string& name, std::vector<Replacement>& replacements) {
  const toml::table* table = style_of(document, style.guest);
  if (!table) return false;
  const toml::node* words = table->get("words");
  auto replacement =
      words ? string_at(text, *words, toml_text(style.words)) : std::optional<Replacement>();
  if (!replacement)
    return tl::make_unexpected(
        error_at(name, table->source(), "this [[style]] has no words = \"…\"; write it there"));
  replacements.push_back(std::move(*replacement));
  return true;
}

Result<std::string> edited(std::string_view text, const toml::table& document,
                           const SessionEdit& edit, const std::string& name) {
  std::vector<Replacement> replacements;
  const bool has_routes = document.contains("route");
  if (!edit.words.empty() && has_routes) {
    const toml::table* route = table_of(document, "route", edit.route);
    if (!route)
      return fail(name + " has no route " + std::to_string(edit.route + 1) +
                  "; open the house anew");
    if (auto done = edit_words(text, *route, edit, name, replacements); !done)
      return tl::make_unexpected(done.error());
  }
  bool has_style = true;
  if (edit.style) {
    DANCE_TRY(has_style, edit_style(text, document, *edit.style, name, replacements));
  }
  std::sort(replacements.begin(), replacements.end(),
            [](const Replacement& a, const Replacement& b) { return a.begin > b.begin; });
  std::string result(text);
  for (const Replacement& it : replacements) result.replace(it.begin, it.size, it.text);
  if (!edit.words.empty() && !has_routes) append_routes(edit, result);
  if (edit.style && !has_style) append_style(*edit.style, result);
  return result;
}

Result<std::vector<std::string>> words_of(const toml::table& document, std::size_t place) {
  std::vector<std::string> words;
  const toml::table* route = table_of(document, "route", place);
  const toml::node* through = route ? route->get("through") : nullptr;
  const toml::array* array = through ? through->as_array() : nullptr;
  if (!array) return words;
  for (const toml::node& node : *array) words.push_back(node.value_or(std::string()));
  return words;
}

const char* music_table(const toml::table& document) {
  return document.contains("music") ? "music" : "window";
}

}  // namespace

std::vector<RouteText> usual_routes() {
  return {{"POSE/capture/*", "POSE/stage/*", {}, 0.0},
          {"POSE/guest/*", "POSE/stage/*", {"predict", "bridge", "rhythm", "stylize"}, 60.0}};
}

Result<std::vector<std::string>> route_words(std::string_view text, std::size_t route,
                                             const std::string& name) {
  return with_toml(text, name,
                   [&](const toml::table& document) { return words_of(document, route); });
}

Result<std::optional<std::string>> style_words(std::string_view text, std::string_view guest,
                                               const std::string& name) {
  using Words = Result<std::optional<std::string>>;
  return with_toml(text, name, [&](const toml::table& document) -> Words {
    const toml::table* table = style_of(document, guest);
    const toml::node* words = table ? table->get("words") : nullptr;
    if (!words) return std::nullopt;
    return words->value<std::string>();
  });
}

Result<double> music_volume(std::string_view text, const std::string& name) {
  return with_toml(text, name, [](const toml::table& document) -> Result<double> {
    const toml::table* table = document[music_table(document)].as_table();
    const toml::node* volume = table ? table->get("volume") : nullptr;
    return volume ? std::clamp(volume->value_or(1.0), 0.0, 1.0) : 1.0;
  });
}

Result<std::string> set_music_volume(std::string_view text, double volume,
                                     const std::string& name) {
  std::string table;
  const auto found = with_toml(text, name, [&](const toml::table& document) -> Result<void> {
    table = music_table(document);
    if (document.contains(table)) return {};
    return fail(name + " has no [music] to keep its volume in");
  });
  if (!found) return tl::make_unexpected(found.error());
  const double shown = std::round(100.0 * std::clamp(volume, 0.0, 1.0)) / 100.0;
  return set_value(text, {table, std::nullopt}, "volume", plain_number(shown), name);
}

Result<std::string> edit_session(std::string_view text, const SessionEdit& edit,
                                 const std::string& name) {
  DANCE_TRY(std::string result, with_toml(text, name, [&](const toml::table& document) {
              return edited(text, document, edit, name);
            }));
  DANCE_TRY(const std::vector<std::string> words, route_words(result, edit.route, name));
  for (const WordEdit& wanted : edit.words)
    if (std::find(words.begin(), words.end(), wanted.text) == words.end())
      return fail(name + ": '" + wanted.word +
                  "' cannot be written where it stands; write it in quotes on one line");
  return result;
}

}  // namespace dance
