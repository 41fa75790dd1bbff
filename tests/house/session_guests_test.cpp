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
