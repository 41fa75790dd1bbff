// The language of the window's texts.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      any.
// Failure:      what is not one of ours is English.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace dance {

enum class Language { kEnglish, kSpanish, kGerman };

struct LanguageName {
  Language language;
  std::string_view code;  // as in a session file and in LANG
  std::string_view name;  // in itself
};
inline constexpr std::array kLanguages{
    LanguageName{Language::kEnglish, "en", "English"},
    LanguageName{Language::kSpanish, "es", "Español"},
    LanguageName{Language::kGerman, "de", "Deutsch"},
};

// "de", or a locale as the system writes it: "de_AT.UTF-8".
std::optional<Language> parse_language(std::string_view text);
// The first that is set of LC_ALL, LC_MESSAGES and LANG.
Language language_of_user();

}  // namespace dance
