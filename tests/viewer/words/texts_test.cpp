#include "viewer/words/texts.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

namespace dance {
namespace {

std::size_t places_in(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = text.find("{}"); at != text.npos; at = text.find("{}", at + 2)) ++count;
  return count;
}

TEST(Texts, EachHasTheSamePlacesToFillInEachLanguage) {
  const Texts english(Language::kEnglish);
  for (const LanguageName& it : kLanguages)
    for (std::size_t i = 0; i < static_cast<std::size_t>(Text::kCount); ++i) {
      const Text text = static_cast<Text>(i);
      EXPECT_EQ(places_in(Texts(it.language)[text]), places_in(english[text])) << english[text];
    }
}

TEST(Texts, AreInTheLanguageAskedFor) {
  EXPECT_STREQ(Texts(Language::kEnglish)[Text::kBack], "Back");
  EXPECT_STREQ(Texts(Language::kSpanish)[Text::kBack], "Volver");
  EXPECT_STREQ(Texts(Language::kGerman)[Text::kBack], "Zurück");
}

TEST(Texts, ALanguageIsKnownByItsCodeOrALocale) {
  EXPECT_EQ(parse_language("de"), Language::kGerman);
  EXPECT_EQ(parse_language("de_AT.UTF-8"), Language::kGerman);
  EXPECT_EQ(parse_language("es-MX"), Language::kSpanish);
  EXPECT_EQ(parse_language("en"), Language::kEnglish);
  EXPECT_EQ(parse_language("C.UTF-8"), std::nullopt);
  EXPECT_EQ(parse_language(""), std::nullopt);
  ::unsetenv("LC_MESSAGES");
  ::setenv("LC_ALL", "", 1);
  ::setenv("LANG", "es_ES.UTF-8", 1);
  EXPECT_EQ(language_of_user(), Language::kSpanish);
  ::setenv("LC_ALL", "C", 1);
  EXPECT_EQ(language_of_user(), Language::kEnglish) << "LC_ALL goes before LANG";
}

}  // namespace
}  // namespace dance
