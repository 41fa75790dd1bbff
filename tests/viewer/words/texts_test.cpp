#include "viewer/words/texts.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/words/shown_name.h"

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

GuestId id(const char* name) { return *GuestId::parse(name); }

ShownNames names_of(std::initializer_list<std::pair<const char*, const char*>> named,
                    std::initializer_list<const char*> others = {}) {
  std::vector<ShownNames::Named> all;
  for (const auto& [guest, name] : named) all.push_back({id(guest), *parse_shown_name(name)});
  std::vector<GuestId> ids;
  for (const char* other : others) ids.push_back(id(other));
  return {all, ids};
}

TEST(ShownNames, AreChosenNamesElseIds) {
  const Texts texts(Language::kEnglish);
  const ShownNames names =
      names_of({{"ana", "Ana L\u00f3pez"}, {"boris", "\u0411\u043e\u0440\u0438\u0441"}},
               {"ana", "boris", "carla"});
  EXPECT_EQ(shown_name(names, id("ana"), texts), "Ana L\u00f3pez");
  EXPECT_EQ(shown_name(names, id("boris"), texts), "\u0411\u043e\u0440\u0438\u0441");
  EXPECT_EQ(shown_name(names, id("carla"), texts), "carla");
  EXPECT_EQ(shown_name(names, id("partner"), texts), "partner");
}

TEST(ShownNames, AppendTheIdIfNamesLookAlike) {
  const ShownNames names =
      names_of({{"ana", "Ana"}, {"ana-2", "\u00c1NA"}, {"mallory", "bob"}, {"eve", "Eve"}},
               {"ana", "ana-2", "mallory", "bob", "eve"});
  EXPECT_EQ(names.find(id("ana")), "Ana (ana)");
  EXPECT_EQ(names.find(id("ana-2")), "\u00c1NA (ana-2)");
  EXPECT_EQ(names.find(id("mallory")), "bob (mallory)") << "bob is the id of another";
  EXPECT_EQ(names.find(id("eve")), "Eve");
}

TEST(ShownNames, AppendTheIdIfANameLooksLikeANameWithAnId) {
  const ShownNames names = names_of({{"ana", "Ana"}, {"mallory", "Ana (ana)"}}, {"ana", "mallory"});
  EXPECT_EQ(names.find(id("ana")), "Ana");
  EXPECT_EQ(names.find(id("mallory")), "Ana (ana) (mallory)");
}

TEST(ShownNames, HaveRoomForTheLongestNameWithTheLongestId) {
  const std::string name(40, 'X'), guest(24, 'g');
  const ShownNames names = names_of({{guest.c_str(), name.c_str()}, {"a", name.c_str()}});
  EXPECT_EQ(names.find(id(guest.c_str())), name + " (" + guest + ")");
}

// The windows' fonts draw question marks for them.
TEST(ShownNames, OmitLettersThatTheFontsLack) {
  const ShownNames names = names_of({{"bob", "\U0001f483 Bob"}, {"mai", "\u821e"}});
  EXPECT_EQ(names.find(id("bob")), "Bob");
  EXPECT_EQ(names.find(id("mai")), "");
  EXPECT_EQ(shown_name(names, id("mai"), Texts(Language::kEnglish)), "mai");
}

TEST(ShownNames, AreInTheReadersLanguageWhereAProgramGaveIt) {
  const Texts german(Language::kGerman);
  EXPECT_EQ(shown_name({}, *GuestId::parse("partner"), german), "Partner");
  EXPECT_EQ(shown_name({}, *GuestId::parse("dancer"), Texts(Language::kSpanish)), "bailarín");
  EXPECT_EQ(shown_name({}, *GuestId::parse("alice"), german), "alice");
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
