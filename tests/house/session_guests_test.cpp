// Who speaks and feels in a house, and other guests than the file's.
#include "house/session_guests.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

const GuestId kAlice = *GuestId::parse("alice"), kBob = *GuestId::parse("bob");

HouseConfig house_of(const std::string& rest) {
  auto session = parse_session("[house]\nguest = \"alice\"\n" + rest, "s.toml");
  EXPECT_TRUE(session) << session.error().what;
  return session.value_or(HouseConfig());
}

std::string error_as(HouseConfig session, std::vector<GuestId> guests) {
  replace_guests(session, std::move(guests));
  const auto checked = check_guests(session);
  return checked ? "" : checked.error().what;
}

TEST(SessionGuests, TheFirstSpeaksWhereTheFileNamesNoOther) {
  HouseConfig session = house_of("[voice]\n");
  replace_guests(session, {kBob, kAlice});
  EXPECT_EQ(session.voice->guest, kBob);
  EXPECT_TRUE(check_guests(session));
}

TEST(SessionGuests, ASpeakerWhomTheFileNamesIsReplacedByNobody) {
  const HouseConfig session = house_of("[voice]\nguest = \"alice\"\n");
  HouseConfig both = session;
  replace_guests(both, {kBob, kAlice});
  EXPECT_EQ(both.voice->guest, kAlice);
  EXPECT_TRUE(check_guests(both));
  const std::string error = error_as(session, {kBob});
  EXPECT_NE(error.find("[voice] guest 'alice' is no guest of this house"), std::string::npos)
      << error;
  EXPECT_NE(error.find("there are: bob; name this guest with --guest"), std::string::npos) << error;
}

TEST(SessionGuests, AcceptsShownNamesOfItsGuestsOnly) {
  HouseConfig session = house_of("guests = [\"bob\"]\n");
  EXPECT_TRUE(set_shown_name(session, "Alicia L\u00f3pez"));
  EXPECT_TRUE(set_shown_name(session, "bob=Bob = the 2nd"));
  EXPECT_EQ(session.shown_names.at(kAlice).view(), "Alicia L\u00f3pez");
  EXPECT_EQ(session.shown_names.at(kBob).view(), "Bob = the 2nd");
  EXPECT_NE(set_shown_name(session, "carla=Carla").error().what.find("is no guest of this house"),
            std::string::npos);
  for (const char* name : {"", "bob=", "bob= ", "A\u202eB", "\x1b[2J"})
    EXPECT_FALSE(set_shown_name(session, name)) << name;
  EXPECT_EQ(session.shown_names.size(), 2u);
  HouseConfig nobody;
  EXPECT_FALSE(set_shown_name(nobody, "Ann"));
}

TEST(SessionGuests, NamesTheLineOfAnInvalidShownName) {
  const auto session = parse_session("[house]\nguest = \"a\"\nshown_name = \"\"\n", "s.toml");
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().what.find("s.toml:3"), std::string::npos) << session.error().what;
}

TEST(SessionGuests, OnlyWatchRemovesAllProducersAndTheVoice) {
  HouseConfig session = house_of(
      "watch = true\n[[produce]]\nkind = \"camera\"\nguest = \"alice\"\n[voice]\n[[haptics]]\n"
      "guest = \"alice\"\nto = \"osc\"\n");
  EXPECT_TRUE(session.watch);
  only_watch(session);
  EXPECT_TRUE(session.cameras.empty() && session.haptics.empty() && !session.voice);
  EXPECT_EQ(session.guests, std::vector<GuestId>{kAlice}) << "whose key opens the room";
  EXPECT_FALSE(house_of("").watch);
}

TEST(SessionGuests, AGuestWhoFeelsMustStillDanceHere) {
  const std::string haptics = "[[haptics]]\nguest = \"alice\"\nto = \"osc\"\n";
  const std::string error = error_as(house_of(haptics), {kBob});
  EXPECT_NE(error.find("[[haptics]] guest 'alice' does not dance in this house"), std::string::npos)
      << error;
  EXPECT_NE(error.find("there are: bob"), std::string::npos) << error;
  EXPECT_EQ(error_as(house_of(haptics), {kBob, kAlice}), "");
  const std::string producer = "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\n";
  EXPECT_EQ(error_as(house_of(producer + haptics), {kBob}), "") << "she dances here still";
}

}  // namespace
}  // namespace dance
