// The names of the mannequin's looks.
#include "formats/body/look_names.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr std::array<float, 3> kWhite{1.0f, 1.0f, 1.0f};
const GuestId kAlice = *GuestId::parse("alice");

TEST(LookNames, TakeWordsInAnyOrder) {
  for (const char* name : {"flared-bun-long", "long-bun-flared", "bun-flared-long"}) {
    const auto look = named_look(kAlice, name, kWhite);
    ASSERT_TRUE(look) << name;
    EXPECT_EQ(look->legwear, Legwear::kFlared);
    EXPECT_EQ(look->hair_style, Hair::kBun);
    EXPECT_EQ(look->sleeves, Sleeves::kLong);
  }
}

TEST(LookNames, LeaveTheRestAsTheGuestsIdMakesIt) {
  const GuestLook own = look_of(kAlice);
  for (const char* name : {"", "mannequin"}) {
    const auto look = named_look(kAlice, name, kWhite);
    ASSERT_TRUE(look);
    EXPECT_EQ(look->hair_style, own.hair_style);
    EXPECT_EQ(look->top, own.top);
  }
  const auto look = named_look(kAlice, "bob", kWhite);
  ASSERT_TRUE(look);
  EXPECT_EQ(look->hair_style, Hair::kBob);
  EXPECT_EQ(look->sleeves, own.sleeves);
  EXPECT_EQ(look->skin, own.skin);
}

TEST(LookNames, TintTheTopAndAWholeDress) {
  const auto look = named_look(kAlice, "dress", {0.5f, 0.0f, 0.25f});
  ASSERT_TRUE(look);
  EXPECT_EQ(look->top, Eigen::Vector3f(0.5f, 0.0f, 0.25f));
  EXPECT_EQ(look->legs, Eigen::Vector3f(0.8f * look->top));
  const auto trousers = named_look(kAlice, "trousers", {0.5f, 0.0f, 0.25f});
  ASSERT_TRUE(trousers);
  EXPECT_NE(trousers->legs, Eigen::Vector3f(0.8f * trousers->top));
}

TEST(LookNames, ChooseSkinAndTheColourOfTheHair) {
  const auto look = named_look(kAlice, "bun-s6-h4", kWhite);
  ASSERT_TRUE(look);
  EXPECT_EQ(look->skin, linear_from_srgb(kSkinColours[5]));
  EXPECT_EQ(look->hair, linear_from_srgb(kHairColours[3]));
  EXPECT_EQ(look->top, look_of(kAlice).top);
  EXPECT_FALSE(is_look_name("s1-s2"));
  EXPECT_FALSE(is_look_name("s7"));
}

TEST(LookNames, NameOfALookMakesTheSameLookForAnotherGuest) {
  for (const char* guest : {"alice", "bob", "carla", "dora"}) {
    const GuestLook look = look_of(*GuestId::parse(guest));
    const std::string name = name_of_look(look);
    ASSERT_TRUE(GuestId::parse(name)) << name;
    const auto same = named_look(*GuestId::parse("erik"), name, kWhite);
    ASSERT_TRUE(same) << name;
    EXPECT_EQ(same->skin, look.skin);
    EXPECT_EQ(same->hair, look.hair);
    EXPECT_EQ(same->hair_style, look.hair_style);
    EXPECT_EQ(same->legwear, look.legwear);
    EXPECT_EQ(same->sleeves, look.sleeves);
  }
}

TEST(LookNames, FitIntoAnAvatarsNameWithAWordOfEachKind) {
  const std::string longest = "trousers-crop-long-s1-h1";
  EXPECT_TRUE(is_look_name(longest));
  EXPECT_TRUE(GuestId::parse(longest));
}

TEST(LookNames, RefuseOtherWordsAndTwoForOneThing) {
  for (const char* name : {"bun-bob", "hat", "bun-", "-bun", "-", "mannequin-bun", "bunbob"})
    EXPECT_FALSE(is_look_name(name)) << name;
  EXPECT_NE(look_names().find("flared"), std::string::npos);
}

}  // namespace
}  // namespace dance
