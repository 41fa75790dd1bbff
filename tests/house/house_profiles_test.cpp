// Tests the profiles that a house publishes: shown names, and the sign that it records.
#include "house/house_profiles.h"

#include <gtest/gtest.h>

#include "tests/core/bus/port_double.h"

namespace dance {
namespace {

constexpr std::uint64_t kClock = 7;

class HouseProfilesTest : public ::testing::Test {
 protected:
  HouseProfiles open(const std::string& file) {
    const auto session = parse_session(file, "s.toml");
    EXPECT_TRUE(session) << session.error().what;
    port.subscribe<Profile>({Where::kCapture, GuestId()},
                            [this](const Channel& channel, const Profile& profile, MonoTime) {
                              published[std::string(channel.guest().view())] = profile;
                            });
    return {*session, port, port, kClock};
  }
  void report(std::uint64_t viewer, bool is_recording, MonoTime now) {
    port.now = now;
    port.publish(Channel::of_house(Signal::kRecording),
                 RecordingState{now, kClock, viewer, is_recording});
  }
  static MonoTime at(int seconds) { return MonoTime::from_us(seconds * 1'000'000LL); }

  PortDouble port;
  std::map<std::string, Profile> published;
};

TEST_F(HouseProfilesTest, PublishesTheShownNamesOfTheHouseFile) {
  HouseProfiles profiles = open(
      "[house]\nguests = [\"alice\", \"ann\", \"al\"]\nshown_name = \"Alicia L\u00f3pez\"\n"
      "shown_names = [\"ann=Ann\"]\n");
  profiles.publish_second(at(1));
  ASSERT_EQ(published.size(), 2u) << "al has neither a name nor a sign";
  EXPECT_EQ(published["alice"].shown_name.view(), "Alicia L\u00f3pez");
  EXPECT_EQ(published["ann"].shown_name.view(), "Ann");
  EXPECT_EQ(published["ann"].clock_id, kClock);
  EXPECT_FALSE(published["alice"].is_recording);
}

TEST_F(HouseProfilesTest, PublishesBeginAndEndOfAWindowsRecordingAtOnce) {
  HouseProfiles profiles = open("[house]\nguest = \"alice\"\n");
  profiles.publish_second(at(1));
  EXPECT_TRUE(published.empty());
  report(11, true, at(2));
  EXPECT_TRUE(published["alice"].is_recording);
  report(12, true, at(3));
  report(11, false, at(4));
  EXPECT_TRUE(published["alice"].is_recording) << "the other window goes on";
  report(12, false, at(4));
  EXPECT_FALSE(published["alice"].is_recording);
}

TEST_F(HouseProfilesTest, AWindowRenamesAGuestAndTheSignsStay) {
  HouseProfiles profiles =
      open("[house]\nguests = [\"alice\", \"ann\"]\nshown_name = \"Alicia\"\n");
  report(11, true, at(2));
  const auto rename = [&](const char* guest, const char* name, MonoTime now) {
    Profile profile{now, kClock, ShownName(), false, true};
    EXPECT_TRUE(profile.shown_name.assign(name));
    port.now = now;
    port.publish(Where::kCapture, *GuestId::parse(guest), profile);
  };
  rename("alice", "Ali", at(3));
  EXPECT_EQ(published["alice"].shown_name.view(), "Ali");
  EXPECT_TRUE(published["alice"].is_recording) << "the window's message has no sign";
  EXPECT_FALSE(published["alice"].is_host);
  EXPECT_EQ(published["ann"].shown_name.view(), "");
  profiles.publish_second(at(4));
  EXPECT_EQ(published["alice"].shown_name.view(), "Ali");
  rename("alice", "", at(5));
  profiles.publish_second(at(6));
  EXPECT_EQ(published["alice"].shown_name.view(), "") << "the id is shown again";
  // A guest of another house keeps the name that its house gives it.
  rename("bob", "Bob", at(7));
  profiles.publish_second(at(8));
  EXPECT_EQ(published["bob"].time, at(7));
}

// A house that accepts this guest's captures from the bus receives its own profiles there, too.
TEST_F(HouseProfilesTest, AnOlderProfileOfItsOwnDoesNotTakeANewNameBack) {
  HouseProfiles profiles = open("[house]\nguest = \"alice\"\nshown_name = \"Alicia\"\n");
  profiles.publish_second(at(1));
  const Profile own = published["alice"];
  port.now = at(2);
  Profile renamed{at(2) + Duration::ms(1), kClock, ShownName(), false, false};
  ASSERT_TRUE(renamed.shown_name.assign("Ali"));
  port.publish(Where::kCapture, *GuestId::parse("alice"), renamed);
  port.publish(Where::kCapture, *GuestId::parse("alice"), own);
  profiles.publish_second(at(3));
  EXPECT_EQ(published["alice"].shown_name.view(), "Ali");
}

TEST_F(HouseProfilesTest, DropsAWindowThatEndedWithoutAReport) {
  HouseProfiles profiles = open("[house]\nguest = \"alice\"\n");
  report(11, true, at(2));
  profiles.publish_second(at(5));
  EXPECT_TRUE(published["alice"].is_recording);
  profiles.publish_second(at(6));
  EXPECT_FALSE(published["alice"].is_recording);
}

TEST_F(HouseProfilesTest, CountsFilesOfTheStageButNotOfOwnCaptures) {
  const std::string house =
      "[house]\nguest = \"alice\"\n[[listen]]\nto = \"csv\"\nfile = \"x.csv\"\n";
  EXPECT_TRUE(open(house + "from = \"POSE/stage/*\"\n").is_recording());
  EXPECT_FALSE(open(house + "from = \"POSE/capture/*\"\n").is_recording());
}

TEST_F(HouseProfilesTest, PublishesNothingForAHouseThatOnlyWatches) {
  HouseProfiles profiles = open("[house]\nguest = \"alice\"\nwatch = true\nshown_name = \"A\"\n");
  profiles.publish_second(at(1));
  EXPECT_TRUE(published.empty());
}

}  // namespace
}  // namespace dance
