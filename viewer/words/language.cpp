#include "viewer/words/language.h"

#include <cstdlib>

namespace dance {

std::optional<Language> parse_language(std::string_view text) {
  const std::string_view code = text.substr(0, text.find_first_of("_.@-"));
  for (const LanguageName& it : kLanguages)
    if (it.code == code) return it.language;
  return std::nullopt;
}

Language language_of_user() {
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    return parse_language(value).value_or(Language::kEnglish);
  }
  return Language::kEnglish;
}

}  // namespace dance
