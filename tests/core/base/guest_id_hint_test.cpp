// Names as people write them, and the guest ids that are suggested for them.
#include "core/base/text/guest_id_hint.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace dance {
namespace {

TEST(GuestIdHint, SuggestsWhatANameIsInPlainLetters) {
  EXPECT_EQ(suggested_guest_id("José"), "jose");
  EXPECT_EQ(suggested_guest_id("Jose\u0301"), "jose");  // the accent as a character of its own
  EXPECT_EQ(suggested_guest_id("Anna Maria"), "anna-maria");
  EXPECT_EQ(suggested_guest_id("  Jörg_Müller  "), "joerg-mueller");
  EXPECT_EQ(suggested_guest_id("WEISS/Groß"), "weiss-gross");
  EXPECT_EQ(suggested_guest_id("Łukasz Żółć"), "lukasz-zolc");
  EXPECT_EQ(suggested_guest_id("Ægir Þór"), "aegir-thor");
  EXPECT_EQ(suggested_guest_id("DJ 3×3"), "dj-3-3");
  EXPECT_EQ(suggested_guest_id("Zoë 💃 2"), "zoe-2");
  EXPECT_EQ(suggested_guest_id("alice"), "alice");
}

TEST(GuestIdHint, SuggestsNothingForANameWithoutLatinLetters) {
  for (const char* name : {"", "   ", "---", "Ελένη", "мария", "\xc3", "\xff\xfe"})
    EXPECT_EQ(suggested_guest_id(name), "") << name;
}

TEST(GuestIdHint, SuggestsOnlyGuestIds) {
  Random random(11);
  for (int i = 0; i < 20'000; ++i) {
    std::string name;
    for (int size = static_cast<int>(random.uniform(0.0, 40.0)); size > 0; --size)
      name += static_cast<char>(static_cast<int>(random.uniform(0.0, 256.0)));
    const std::string id = suggested_guest_id(name);
    EXPECT_TRUE(id.empty() || GuestId::parse(id)) << id;
  }
  EXPECT_EQ(suggested_guest_id(std::string(23, 'x') + " y").size(), 23u);
  EXPECT_EQ(suggested_guest_id(std::string(23, 'x') + "ß").size(), 24u);
}

TEST(GuestIdHint, AnErrorNamesTheRuleAndTheSuggestion) {
  const std::string error = guest_id_error("José");
  EXPECT_NE(error.find("'José': "), std::string::npos) << error;
  EXPECT_NE(error.find(kGuestIdRule), std::string::npos) << error;
  EXPECT_NE(error.find("'jose' is one"), std::string::npos) << error;
  EXPECT_EQ(guest_id_error("мария").find("is one"), std::string::npos);
}

}  // namespace
}  // namespace dance
