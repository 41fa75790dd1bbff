// Voices on a narrow line: poses first.
#include <gtest/gtest.h>

#include <limits>

#include "tests/tunnel/voice/voices.h"
#include "tunnel/server/voice/voice_share.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

MonoTime at(double seconds) { return MonoTime::from_us(1'000'000) + Duration::seconds(seconds); }

TEST(VoiceShare, WholeVoicesOrNone) {
  VoiceShare share;
  // Two who speak, 108 bytes a packet with all headers: 10,800 bytes a second each.
  const std::size_t packet = 108 - VoiceShare::cost_of(0);
  for (int i = 0; i < 200; ++i) share.note_wanted(packet);
  share.sample(1.0);
  EXPECT_DOUBLE_EQ(share.wanted_bytes_per_s(), 21'600.0);
  share.settle(false, std::numeric_limits<double>::infinity(), at(0.0));
  EXPECT_EQ(share.voices(), kMaxTalkers);
  share.settle(true, 25'000.0, at(0.1));
  EXPECT_EQ(share.voices(), 2u);
  share.settle(true, 20'000.0, at(0.2));
  EXPECT_EQ(share.voices(), 1u);
  share.settle(true, 10'000.0, at(0.3));
  EXPECT_EQ(share.voices(), 0u) << "half a voice is no speech";
  share.settle(true, -5.0, at(0.4));
  EXPECT_EQ(share.voices(), 0u);
}

TEST(VoiceShare, TheyComeBackOneByOneAndMoreSlowlyEachTimeThatWasTooEarly) {
  VoiceShare share;
  share.settle(true, 0.0, at(0.0));
  ASSERT_EQ(share.voices(), 0u);
  share.settle(true, 1e6, at(1.9));
  EXPECT_EQ(share.voices(), 0u);
  share.settle(true, 1e6, at(2.0));
  EXPECT_EQ(share.voices(), 1u);
  share.settle(true, 1e6, at(3.9));
  EXPECT_EQ(share.voices(), 1u);
  share.settle(true, 1e6, at(4.0));
  EXPECT_EQ(share.voices(), 2u);
  share.settle(true, 11'000.0, at(5.0));  // that was one too many
  EXPECT_EQ(share.voices(), 1u);
  share.settle(true, 1e6, at(8.9));
  EXPECT_EQ(share.voices(), 1u);
  share.settle(true, 1e6, at(9.0));
  EXPECT_EQ(share.voices(), 2u);
  share.settle(true, 11'000.0, at(10.0));
  share.settle(true, 1e6, at(17.9));
  EXPECT_EQ(share.voices(), 1u);
  share.settle(true, 1e6, at(18.0));
  EXPECT_EQ(share.voices(), 2u);
}

TEST(VoiceShare, ABurstGoesNoFasterThanTheLineTakesIt) {
  VoiceShare share;
  EXPECT_TRUE(share.take(1'000'000, at(0.0))) << "no limit";
  share.settle(true, 20'000.0, at(0.0));
  std::size_t sent = 0;
  while (share.take(100, at(0.1))) sent += 100;
  EXPECT_EQ(sent, 600u) << "30 ms of it";
  sent = 0;
  for (int ms = 1; ms <= 1000; ++ms)
    while (share.take(100, at(0.1 + ms * 1e-3))) sent += 100;
  EXPECT_NEAR(static_cast<double>(sent), 20'000.0, 200.0);
}

// A line down to bob that bears the poses of four, and not their voices.
TEST(VoiceLine, PosesComeWholeWhereTheLineBearsThemAndNotTheVoices) {
  SimulatedTunnel tunnel;
  ASSERT_TRUE(tunnel.link_options.codecs.try_push({CodecId::kPlain, 0}));
  House& bob = tunnel.add_house("salsa", {"bob"});
  std::vector<House*> others;
  Talk talk{tunnel, {}};
  for (int i = 0; i < 4; ++i) {
    others.push_back(&tunnel.add_house("salsa", {"t" + std::to_string(i)}));
    others.back()->link->send(guest("t" + std::to_string(i)), Skeleton(),
                              tunnel.time_in(*others.back()));
    talk.talkers.push_back({others.back(), guest("t" + std::to_string(i))});
  }
  double line_bytes_per_s = 1e9, queued = 0.0, sent = 0.0;
  std::size_t lost = 0;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (to_server || peer != bob.peer) return true;
    const auto size = static_cast<double>(bytes.size() + wire::kSealOverhead + kIpUdp_bytes);
    sent += size;
    if (queued + size > line_bytes_per_s * 0.25) {
      ++lost;
      return false;
    }
    queued += size;
    bob.down = Duration::ms(5) + Duration::seconds(queued / line_bytes_per_s);
    return true;
  };
  const auto run = [&](int seconds, bool with_voices) {
    tunnel.run(Duration::s(seconds), [&] {
      queued = std::max(0.0, queued - line_bytes_per_s * 1e-3);
      const auto ms = static_cast<int>(tunnel.now().since_zero_us() / 1000);
      for (std::size_t i = 0; i < others.size(); ++i) {
        if (ms % 20 == static_cast<int>(4 * i)) tunnel.dance(*others[i], talk.talkers[i].guest);
        if (with_voices && ms % 10 == static_cast<int>(2 * i)) talk.say(talk.talkers[i]);
      }
    });
  };
  run(5, false);
  sent = 0.0;
  run(5, false);
  const double of_poses = sent / 5.0;
  // Room for the poses and for not quite one voice of four.
  line_bytes_per_s = of_poses + 9'000.0;
  run(20, true);  // time to learn the line
  bob.poses.clear();
  bob.voices.clear();
  lost = 0;
  run(30, true);
  const double poses_share = static_cast<double>(bob.poses.size()) / (4 * 50 * 30.0);
  EXPECT_GT(poses_share, 0.95);
  EXPECT_LT(static_cast<double>(bob.voices.size()), 0.3 * 4 * 100 * 30);
  EXPECT_GT(tunnel.server().counters().voices_held_back, 5'000u);
  // And on a wide one all voices come again.
  line_bytes_per_s = 1e9;
  run(60, true);
  bob.voices.clear();
  run(5, true);
  EXPECT_NEAR(static_cast<double>(bob.voices.size()), 4 * 100 * 5.0, 50.0);
}

}  // namespace
}  // namespace dance
