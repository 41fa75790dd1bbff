// Records that go the same way share datagrams, and what that saves.
#include <gtest/gtest.h>

#include "tests/tunnel/referring_codec.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

TEST(SharedDatagrams, TheGuestsOfOneHouseShareThem) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice", "anna", "arno"});
  auto& b = tunnel.add_house("salsa", {});
  tunnel.run(Duration::s(1));
  const auto before = a.link->counters().datagrams_out;
  Dance{tunnel, {{&a, guest("alice")}, {&a, guest("anna")}, {&a, guest("arno")}}}.run(
      Duration::s(2));
  tunnel.run(Duration::ms(50));
  EXPECT_EQ(b.poses.size(), a.link->counters().poses_sent);
  EXPECT_LT(a.link->counters().datagrams_out - before, a.link->counters().poses_sent / 2);
}

TEST(SharedDatagrams, AWindowMakesThemFewerAndAPairNeverWaits) {
  ServerLimits limits;
  limits.share_window = Duration::ms(4);
  SimulatedTunnel tunnel(limits);
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}}.run(Duration::s(1));
  EXPECT_NEAR((b.poses.back().at - b.poses.back().pose.capture_time).as_ms(), 20.0, 0.1);
  // Others, each a millisecond after the one before.
  std::vector<House*> houses{&a, &b};
  for (int i = 0; i < 14; ++i)
    houses.push_back(&tunnel.add_house("salsa", {"guest-" + std::to_string(i)}));
  const auto dance = [&](Duration duration) {
    tunnel.run(duration, [&] {
      const auto who = static_cast<std::size_t>(tunnel.now().since_zero_us() / 1000 % 16);
      tunnel.dance(*houses[who], who == 0   ? guest("alice")
                                 : who == 1 ? guest("bob")
                                            : guest("guest-" + std::to_string(who - 2)));
    });
  };
  dance(Duration::s(1));
  const ServerCounters before = tunnel.server().counters();
  const auto heard = a.poses.size();
  dance(Duration::s(1));
  const ServerCounters& after = tunnel.server().counters();
  EXPECT_NEAR(static_cast<double>(a.poses.size() - heard), 15 * 62.5, 20.0);
  EXPECT_LT((after.datagrams_out - before.datagrams_out) * 3,
            after.records_out - before.records_out);
}

TEST(SharedDatagrams, PosesGoAtOnceHoweverManyDance) {
  SimulatedTunnel tunnel;
  std::vector<House*> houses;
  for (int i = 0; i < 30; ++i)
    houses.push_back(&tunnel.add_house("salsa", {"guest-" + std::to_string(i)}));
  tunnel.run(Duration::s(2), [&] {
    const auto moment = static_cast<std::size_t>(tunnel.now().since_zero_us() / 1000 % 15);
    for (std::size_t who = moment; who < houses.size(); who += 15)
      tunnel.dance(*houses[who], guest("guest-" + std::to_string(who)));
  });
  ASSERT_GT(houses[0]->poses.size(), 3000u);
  for (const auto& heard : houses[0]->poses)
    EXPECT_NEAR((heard.at - heard.pose.capture_time).as_ms(), 20.0, 0.1) << "the line's own";
}

// A payload of 35 bytes, whatever is danced.
class BriefCodec final : public PoseEncoder, public PoseDecoder {
 public:
  static constexpr std::size_t kBytes = 35;
  CodecName name() const override { return kReferring; }
  std::size_t encode(const Pose&, std::span<std::uint8_t> payload) override {
    std::fill_n(payload.begin(), kBytes, std::uint8_t{1});
    return kBytes;
  }
  DecodeResult decode(std::uint32_t, std::span<const std::uint8_t>, Pose& pose) override {
    pose = Pose();
    return DecodeResult::kPose;
  }
  void restart() override {}
  void set_skeleton(const Skeleton&) override {}
};

// What one of thirty hears in a second at 60 Hz, with the seal and the headers of IP and UDP.
// `phases`: in how many milliseconds of a frame the others dance.
double heard_kB_per_s(std::size_t phases) {
  ServerLimits limits;
  limits.share_window = Duration::ms(4);
  SimulatedTunnel tunnel(limits);
  if (!tunnel.link_options.codecs.try_push(kReferring)) std::abort();
  tunnel.link_options.make_encoder = [](CodecName) { return std::make_unique<BriefCodec>(); };
  tunnel.link_options.make_decoder = [](CodecName) { return std::make_unique<BriefCodec>(); };
  std::vector<House*> houses;
  for (int i = 0; i < 30; ++i)
    houses.push_back(&tunnel.add_house("salsa", {"guest-" + std::to_string(i)}));
  std::size_t bytes = 0, records = 0;
  const auto dance = [&](Duration duration) {
    tunnel.run(duration, [&] {
      const auto phase = static_cast<std::size_t>(tunnel.now().since_zero_us() / 1000 % 16);
      for (std::size_t i = 0; i < houses.size(); ++i)
        if (i % phases == phase) tunnel.dance(*houses[i], guest("guest-" + std::to_string(i)));
    });
  };
  dance(Duration::s(2));
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes datagram) {
    if (to_server || peer != houses[7]->peer) return true;
    bytes += datagram.size() + wire::kSealOverhead + kIpUdp_bytes;
    return true;
  };
  const auto before = houses[7]->poses.size();
  dance(Duration::s(2));
  records = houses[7]->poses.size() - before;
  return static_cast<double>(bytes) / static_cast<double>(records) * 29 * 60 / 1000.0;
}

TEST(SharedDatagrams, ThirtyDancersCostLittleMoreThanTheirPayloads) {
  EXPECT_LT(heard_kB_per_s(1), 88.0) << "in step";
  EXPECT_LT(heard_kB_per_s(16), 88.0) << "each when it likes";
}

}  // namespace
}  // namespace dance
