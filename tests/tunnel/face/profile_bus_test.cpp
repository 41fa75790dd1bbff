// Tests the profile of a guest (shown name, recording sign, host sign) that other houses receive.
#include "tests/tunnel/removal/two_houses.h"
#include "tunnel/session/profile_bytes.h"

namespace dance {
namespace {

std::vector<std::uint8_t> written(const Profile& profile) {
  ProfileBytes bytes;
  const std::size_t size = write_profile(profile, bytes);
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(ProfileBytes, StayAsTheyAreOnTheWire) {
  Profile profile;
  EXPECT_EQ(written(profile), bytes_of(std::string_view("\0", 1)));
  profile.is_recording = true;
  profile.shown_name = *parse_shown_name("Zo\u00eb");
  EXPECT_EQ(written(profile), bytes_of("\x01Zo\xc3\xab"));
  profile.shown_name = *parse_shown_name(std::string(40, 'x'));
  EXPECT_EQ(written(profile).size(), kMaxProfileBytes);
}

TEST(ProfileBytes, AreReadAsTheyWereWritten) {
  const auto read = parse_profile(bytes_of("\x01Zo\xc3\xab"));
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->is_recording);
  EXPECT_EQ(read->shown_name.view(), "Zo\u00eb");
  EXPECT_TRUE(parse_profile(bytes_of(std::string_view("\0", 1)))->shown_name.empty());
  EXPECT_TRUE(parse_profile(bytes_of("\x02"))->is_host);
  EXPECT_FALSE(parse_profile(bytes_of("\x84Zo"))->is_recording) << "signs of a later version";
}

TEST(ProfileBytes, AreRefusedIfTheNameIsInvalid) {
  const std::vector<std::string> invalid{"\x1b[2J", "A\u202enA", "Ana\n",  " Ana",
                                         "\xff",    "Zo\xc3",    "\u3164", std::string(41, 'x')};
  for (const std::string& name : invalid)
    EXPECT_FALSE(parse_profile(bytes_of(std::string(1, '\0') + name))) << name;
  EXPECT_FALSE(parse_profile({}));
}

class ProfileBus : public RemovalHouses {
 protected:
  void SetUp() override {
    RemovalHouses::SetUp();
    if (HasFatalFailure()) return;
    host_->viewer->subscribe<Profile>(
        Where::kGuest, [this](const Channel& channel, const Profile& profile, MonoTime) {
          EXPECT_EQ(channel.guest(), named("bob"));
          received_ = profile;
        });
    poller_->add_timer(mono_now(), [this](MonoTime now) {
      if (profile_) bob_->port->publish(Where::kCapture, named("bob"), *profile_);
      return now + Duration::ms(30);
    });
  }

  std::optional<Profile> profile_, received_;
};

TEST_F(ProfileBus, ReportsANameAndItsChangeToTheOtherHouse) {
  profile_ = Profile{MonoTime(), this_clock_id(), *parse_shown_name("Bj\u00f6rn Borg"), false};
  ASSERT_TRUE(turn_until([&] { return received_.has_value(); }));
  EXPECT_EQ(received_->shown_name.view(), "Bj\u00f6rn Borg");
  EXPECT_FALSE(received_->is_recording);
  EXPECT_EQ(received_->clock_id, this_clock_id());
  profile_->shown_name = ShownName();
  ASSERT_TRUE(turn_until([&] { return received_->shown_name.empty(); }));
}

TEST_F(ProfileBus, ReportsThatAHouseRecordsAndThatItHasStopped) {
  profile_ = Profile{MonoTime(), this_clock_id(), ShownName(), true};
  ASSERT_TRUE(turn_until([&] { return received_ && received_->is_recording; }));
  profile_->is_recording = false;
  ASSERT_TRUE(turn_until([&] { return !received_->is_recording; }));
}

TEST_F(ProfileBus, SendsTheHostSignAlsoWithoutAProfile) {
  std::optional<Profile> of_host;
  bob_->viewer->subscribe<Profile>(Where::kGuest,
                                   [&](const Channel& channel, const Profile& profile, MonoTime) {
                                     EXPECT_EQ(channel.guest(), named("hanna"));
                                     of_host = profile;
                                   });
  ASSERT_TRUE(turn_until([&] { return of_host && of_host->is_host; }));
  EXPECT_TRUE(of_host->shown_name.empty());
  profile_ = Profile{MonoTime(), this_clock_id(), *parse_shown_name("Bob"), false, true};
  ASSERT_TRUE(turn_until([&] { return received_.has_value(); }));
  EXPECT_FALSE(received_->is_host) << "the server decides, not the capture";
}

TEST_F(ProfileBus, SendsOnlyChanges) {
  profile_ = Profile{MonoTime(), this_clock_id(), *parse_shown_name("Bob"), false};
  ASSERT_TRUE(turn_until([&] { return received_.has_value(); }));
  const auto sent = bob_->link->core().counters().channels_sent;
  const MonoTime end = mono_now() + Duration::ms(500);
  while (mono_now() < end) poller_->run_once(Duration::ms(5));
  EXPECT_EQ(bob_->link->core().counters().channels_sent, sent);
  EXPECT_EQ(host_->link->core().counters().channels_invalid, 0u);
}

}  // namespace
}  // namespace dance
