// Many who speak at once: each receiver hears eight of them.
#include <gtest/gtest.h>

#include <set>

#include "tests/allocation_guard.h"
#include "tests/tunnel/voice/voices.h"
#include "tunnel/server/voice/talker_places.h"
#include "tunnel/server/voice/voice_queue.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

TEST(Loudness, IsTheNewestOrWhatIsLeftOfLouderOnes) {
  Loudness loudness;
  const MonoTime begin = MonoTime::from_us(1'000'000);
  EXPECT_EQ(loudness.at(begin), kSilence_dbfs);
  loudness.add(-20, begin);
  EXPECT_DOUBLE_EQ(loudness.at(begin), -20.0);
  EXPECT_DOUBLE_EQ(loudness.at(begin + Duration::ms(500)), -30.0);
  loudness.add(-60, begin + Duration::ms(500));
  EXPECT_DOUBLE_EQ(loudness.at(begin + Duration::ms(500)), -30.0);
  loudness.add(-25, begin + Duration::ms(500));
  EXPECT_DOUBLE_EQ(loudness.at(begin + Duration::ms(500)), -25.0);
  EXPECT_DOUBLE_EQ(loudness.at(begin + Duration::s(60)), kSilence_dbfs);
}

TEST(TalkerPlaces, AreLeftBySilenceAndTakenByWhoIsClearlyLouder) {
  TalkerPlaces places;
  MonoTime now = MonoTime::from_us(1'000'000);
  std::array<double, 20> loudness{};
  const auto take = [&](std::uint8_t slot) {
    return places.take(slot, now, [&](std::uint8_t of) { return loudness[of]; });
  };
  for (std::uint8_t slot = 0; slot < kMaxTalkers; ++slot) {
    loudness[slot] = -20.0 - slot;
    EXPECT_EQ(take(slot), slot);
  }
  EXPECT_EQ(take(3), 3u) << "keeps it";
  loudness[10] = -22.0;
  EXPECT_EQ(take(10), kMaxTalkers) << "not clearly louder than -27";
  loudness[10] = -21.0;
  EXPECT_EQ(take(10), 7u);
  EXPECT_EQ(take(7), kMaxTalkers) << "whose place it was";
  now += Duration::ms(501);
  for (const int slot : {1, 2, 3, 4, 5, 6, 10}) take(static_cast<std::uint8_t>(slot));
  EXPECT_EQ(take(7), 7u) << "0 has fallen silent";
  EXPECT_EQ(take(1), 0u) << "the longest heard come first";
}

TEST(VoiceQueue, TheNewestStayAndNothingStaysLong) {
  VoiceQueue queue;
  const MonoTime begin = MonoTime::from_us(1'000'000);
  std::array<std::uint8_t, 4> packet{1, 2, 3, 4};
  std::size_t left = 0;
  for (std::uint32_t i = 0; i < VoiceQueue::kCapacity + 5; ++i) {
    packet[0] = static_cast<std::uint8_t>(i);
    left += queue.push({{1, 1}, i, 0, -3, packet}, begin + Duration::ms(i)) ? 1 : 0;
  }
  EXPECT_EQ(left, 5u);
  EXPECT_EQ(queue.size(), VoiceQueue::kCapacity);
  EXPECT_EQ(queue.front().sequence, 5u);
  EXPECT_EQ(queue.front().packet[0], 5);
  EXPECT_EQ(queue.front().packet.size(), 4u);
  EXPECT_EQ(queue.drop_late(begin + Duration::ms(65)), 0u);
  EXPECT_EQ(queue.drop_late(begin + Duration::ms(70)), 5u);
  EXPECT_EQ(queue.front().sequence, 10u);
  EXPECT_EQ(queue.drop_late(begin + Duration::s(9)), VoiceQueue::kCapacity - 5);
  EXPECT_TRUE(queue.is_empty());
}

class VoiceCrowd : public ::testing::Test {
 protected:
  static constexpr int kTalkers = 12;
  VoiceCrowd() {
    for (int i = 0; i < kTalkers; ++i) {
      House& house = tunnel.add_house("salsa", {"t" + std::to_string(i)});
      talk.talkers.push_back({&house, guest("t" + std::to_string(i)), -30});
    }
    tunnel.run(Duration::ms(200));
  }
  std::set<std::string> heard_in(Duration duration) {
    listener.voices.clear();
    talk.run(duration);
    std::set<std::string> names;
    for (const auto& heard : listener.voices) names.emplace(heard.guest.view());
    return names;
  }
  SimulatedTunnel tunnel;
  House& listener = tunnel.add_house("salsa", {});
  Talk talk{tunnel, {}};
};

TEST_F(VoiceCrowd, EightAreHeardWholeAndTheOthersNot) {
  heard_in(Duration::ms(100));
  EXPECT_EQ(heard_in(Duration::s(1)).size(), kMaxTalkers);
  // Whole voices: eight hundred packets of the eight.
  EXPECT_EQ(listener.voices.size(), 100u * kMaxTalkers);
  EXPECT_GT(tunnel.server().counters().voices_crowded, 400u);
  // Those who speak have seven others' places and their own voice.
  std::set<std::string> at_first;
  for (const auto& heard : talk.talkers[0].house->voices) at_first.emplace(heard.guest.view());
  EXPECT_EQ(at_first.size(), kMaxTalkers);
  EXPECT_FALSE(at_first.contains("t0"));
}

TEST_F(VoiceCrowd, WhoIsClearlyLouderIsHeardInstead) {
  heard_in(Duration::ms(100));
  EXPECT_FALSE(heard_in(Duration::ms(100)).contains("t11"));
  talk.talkers[11].level_dbfs = -10;
  EXPECT_TRUE(heard_in(Duration::ms(100)).contains("t11"));
  EXPECT_EQ(heard_in(Duration::ms(100)).size(), kMaxTalkers);
}

TEST_F(VoiceCrowd, WhoIsMutedTakesNoPlace) {
  listener.link->set_hearing(hearing({"t0=0", "t1=0", "t2=0", "t3=0"}), tunnel.time_in(listener));
  tunnel.run(Duration::ms(100));
  const auto names = heard_in(Duration::ms(300));
  EXPECT_EQ(names.size(), kMaxTalkers);
  EXPECT_TRUE(names.contains("t11"));
}

}  // namespace
}  // namespace dance
