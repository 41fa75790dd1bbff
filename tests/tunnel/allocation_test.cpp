// The way of a pose through link, server and link allocates nothing.
#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

// Keeps datagrams where they are until they are handed on; allocates nothing itself.
class FixedSink final : public DatagramSink, public PeerSink {
 public:
  void send(const Address&, std::span<const std::uint8_t> bytes) override { send(0, bytes); }
  void send(PeerId to, std::span<const std::uint8_t> bytes) override {
    kept_[count_].peer = to;
    if (count_ == kept_.size() || bytes.size() > kept_[0].bytes.size()) std::abort();
    kept_[count_].size = bytes.size();
    std::copy(bytes.begin(), bytes.end(), kept_[count_++].bytes.begin());
  }
  template <class Deliver>
  void hand_on(Deliver deliver) {
    const std::size_t count = count_;
    count_ = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Datagram datagram = kept_[i];
      deliver(datagram.peer, wire::Bytes(datagram.bytes.data(), datagram.size));
    }
  }

 private:
  struct Datagram {
    PeerId peer = 0;
    std::array<std::uint8_t, wire::kMaxPlain> bytes;
    std::size_t size = 0;
  };
  std::array<Datagram, 32> kept_;
  std::size_t count_ = 0;
};

TEST(TunnelAllocation, PosesHandsVoicesChannelsStatesAndPingsPassWithoutOne) {
  FixedSink to_server_a;
  FixedSink to_server_b;
  FixedSink to_server_c;
  FixedSink from_server;
  const Access access{.any_name = true};
  Random random(1);
  ServerCore server(
      {}, [&] { return random.next_u64(); }, from_server);
  std::uint64_t poses = 0;
  std::uint64_t hands_heard = 0;
  std::uint64_t poses_of_few = 0;
  std::uint64_t voices = 0;
  LinkOptions options;
  options.room = guest("salsa");
  options.clock_id = 9;
  options.token = 1;
  ASSERT_TRUE(options.guests.try_push(guest("alice")));
  options.channels = {*ChannelRule::parse("ROBOT/arm class=newest rate=240 layout=n:i32,f64[n]"),
                      *ChannelRule::parse("LIGHT/desk class=state rate=20 layout=i64")};
  LinkCore a(options, {}, to_server_a);
  options.token = 2;
  options.seed = 2;
  options.guests[0] = guest("bob");
  LinkHandlers handlers;
  handlers.on_pose = [&](const GuestId&, const Pose&, MonoTime) { ++poses; };
  handlers.on_hands = [&](const GuestId&, const Hands&, MonoTime) { ++hands_heard; };
  handlers.on_voice = [&](const GuestId&, const Voice&, MonoTime) { ++voices; };
  std::uint64_t messages = 0;
  handlers.on_channel = [&](const GuestId&, std::string_view, ChannelClass, wire::Bytes, MonoTime) {
    ++messages;
  };
  LinkCore b(options, handlers, to_server_b);
  // One that only listens, and wants each fourth.
  options.token = 3;
  options.seed = 3;
  options.guests.clear();
  options.listen_only = true;
  options.interest.others = 4;
  handlers = {};
  handlers.on_pose = [&](const GuestId&, const Pose&, MonoTime) { ++poses_of_few; };
  LinkCore c(options, handlers, to_server_c);

  MonoTime now = MonoTime::from_us(1'000'000);
  const auto turn = [&] {
    now += Duration::ms(16);
    a.tick(now);
    b.tick(now);
    c.tick(now);
    to_server_a.hand_on([&](PeerId, wire::Bytes d) { server.receive(1, access, d, now, now); });
    to_server_b.hand_on([&](PeerId, wire::Bytes d) { server.receive(2, access, d, now, now); });
    to_server_c.hand_on([&](PeerId, wire::Bytes d) { server.receive(3, access, d, now, now); });
    server.end_turn(now);
    server.tick(now);
    from_server.hand_on([&](PeerId to, wire::Bytes d) {
      (to == 1 ? a : to == 2 ? b : c).receive(d, now, now);
    });
  };
  a.on_sealed(now);
  b.on_sealed(now);
  c.on_sealed(now);
  for (int i = 0; i < 20; ++i) turn();
  ASSERT_TRUE(a.is_connected() && b.is_connected() && c.is_connected());

  const Pose still = pose_number(0, now, 9);
  Hands hands;
  hands.presence = 3;
  hands.clock_id = 9;
  Voice voice;
  voice.clock_id = 9;
  ASSERT_TRUE(voice.set_packet(std::array<std::uint8_t, 40>{}));
  const std::array<std::uint8_t, 12> arm{};
  std::array<std::uint8_t, 16> light{};
  const AllocationGuard guard;
  for (std::uint32_t i = 1; i <= 1000; ++i) {
    Pose pose = still;
    pose.sequence = hands.sequence = i;
    pose.capture_time = hands.capture_time = now;
    a.send(guest("alice"), pose, now);
    a.send(guest("alice"), hands, now);
    voice.sequence = i;
    voice.capture_time = now;
    a.send(guest("alice"), voice, now);
    a.send_channel("ROBOT/arm", arm, now);
    light[15] = static_cast<std::uint8_t>(i / 20);
    a.send_channel("LIGHT/desk", light, now);
    Placement placement;
    placement.x_m = static_cast<float>(i / 20);
    a.send(guest("alice"), placement, now);
    turn();
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(poses, 1000u);
  EXPECT_EQ(hands_heard, 1000u);
  EXPECT_EQ(voices, 1000u);
  EXPECT_GT(messages, 1000u);
  EXPECT_NEAR(static_cast<double>(poses_of_few), 250.0, 3.0);
}

}  // namespace
}  // namespace dance
