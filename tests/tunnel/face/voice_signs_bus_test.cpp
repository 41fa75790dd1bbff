// The signs of a voice (muted, talking) that the other house receives.
#include "tests/tunnel/removal/two_houses.h"

namespace dance {
namespace {

class VoiceSignsBus : public RemovalHouses {
 protected:
  void SetUp() override {
    RemovalHouses::SetUp();
    if (HasFatalFailure()) return;
    host_->viewer->subscribe<VoiceState>(
        Where::kGuest, [this](const Channel& channel, const VoiceState& state, MonoTime) {
          EXPECT_EQ(channel.guest(), named("bob"));
          received_ = state;
        });
    poller_->add_timer(mono_now(), [this](MonoTime now) {
      if (state_) bob_->port->publish(Where::kCapture, named("bob"), *state_);
      if (talks_) bob_->port->publish(Where::kCapture, named("bob"), speech(now));
      return now + Duration::ms(30);
    });
  }
  static Voice speech(MonoTime now) {
    Voice voice;
    voice.capture_time = now;
    voice.clock_id = this_clock_id();
    voice.level_dbfs = -20;
    EXPECT_TRUE(voice.set_packet(std::array<std::uint8_t, 3>{1, 2, 3}));
    return voice;
  }

  std::optional<VoiceState> state_, received_;
  bool talks_ = false;
};

TEST_F(VoiceSignsBus, ReportsToTheOtherHouseThatAGuestIsMutedAndNoLonger) {
  state_ = VoiceState{};
  state_->clock_id = this_clock_id();
  state_->is_muted = true;
  ASSERT_TRUE(turn_until([&] { return received_ && received_->is_muted; }));
  EXPECT_FALSE(received_->is_deafened);
  EXPECT_TRUE(received_->has_microphone);
  state_->is_muted = false;
  ASSERT_TRUE(turn_until([&] { return !received_->is_muted; }));
}

TEST_F(VoiceSignsBus, ReportsWhoTalksToAHouseThatPlaysNoVoices) {
  HearingWish nobody;
  nobody.clock_id = this_clock_id();
  nobody.listener = named("hanna");
  nobody.hears_others = false;
  bool has_voice = false;
  int published = 0;
  poller_->add_timer(mono_now(), [&](MonoTime now) {
    nobody.time = now;
    host_->port->publish(Channel::of_house(Signal::kHearing), nobody);
    ++published;
    return now + Duration::ms(50);
  });
  ASSERT_TRUE(turn_until([&] { return published > 10; }));
  host_->viewer->subscribe<Voice>(
      Where::kGuest, [&](const Channel&, const Voice&, MonoTime) { has_voice = true; });
  talks_ = true;
  ASSERT_TRUE(turn_until([&] { return received_ && received_->is_heard; }));
  talks_ = false;
  ASSERT_TRUE(turn_until([&] { return !received_->is_heard; }));
  EXPECT_FALSE(has_voice);
}

TEST(VoiceSigns, SendsOnlyChangesAndClearsAVoiceThatEnded) {
  VoiceSigns signs;
  const GuestId bob = named("bob");
  MonoTime now = MonoTime::from_us(50'000'000);
  VoiceState state;
  EXPECT_FALSE(signs.on_state(bob, state, now)) << "other houses assume this";
  state.is_deafened = true;
  const auto deafened = signs.on_state(bob, state, now);
  ASSERT_TRUE(deafened);
  EXPECT_TRUE(VoiceSigns::parse(*deafened)->is_deafened);
  EXPECT_FALSE(signs.on_state(bob, state, now));
  std::optional<std::uint8_t> sent;
  signs.expire(now + Duration::s(4), [&](const GuestId&, std::uint8_t sign) { sent = sign; });
  ASSERT_TRUE(sent);
  EXPECT_FALSE(VoiceSigns::parse(*sent)->is_deafened);
  EXPECT_FALSE(VoiceSigns::parse(16)) << "bits of a later version";
}

TEST(VoiceSigns, MakesRoomForNewGuestsOnceOthersHaveEnded) {
  VoiceSigns signs;
  MonoTime now = MonoTime::from_us(50'000'000);
  VoiceState muted;
  muted.is_muted = true;
  const auto fill = [&](const std::string& name) {
    std::size_t sent = 0;
    for (std::size_t i = 0; i <= VoiceSigns::kMost; ++i)
      sent += signs.on_state(named((name + std::to_string(i)).c_str()), muted, now) ? 1 : 0;
    return sent;
  };
  EXPECT_EQ(fill("guest"), VoiceSigns::kMost);
  now += Duration::s(4);
  std::size_t cleared = 0;
  signs.expire(now, [&](const GuestId&, std::uint8_t sign) { cleared += sign == 0 ? 1 : 0; });
  EXPECT_EQ(cleared, VoiceSigns::kMost);
  EXPECT_EQ(fill("newcomer"), VoiceSigns::kMost);
}

}  // namespace
}  // namespace dance
