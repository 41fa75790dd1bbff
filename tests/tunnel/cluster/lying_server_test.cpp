// A server aims its links at a third host: it lists that host, and says goodbye. Real sockets on
// this machine's loopback address.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/net/mono_clock.h"
#include "tests/tunnel/cluster/listing_server.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/link/link.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

class LyingServer : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller = std::move(*made);
    keys = ring_of(key);
    liar = std::make_unique<ListingServer>(Address::loopback(0), identity, keys, *poller);
    LinkOptions of;
    of.room = guest("salsa");
    ASSERT_TRUE(of.guests.try_push(guest("alice")));
    LinkHandlers handlers;
    handlers.on_other_server = [this](const Address& server) { moves.push_back(server); };
    auto opened = Link::open({liar->address()}, link_key_of(key, identity.public_key()), of,
                             std::move(handlers), *poller);
    ASSERT_TRUE(opened);
    link = std::move(*opened);
    ASSERT_TRUE(dance_until([&] { return liar->poses() > 0; }));
    begin = mono_now();
  }

  static std::shared_ptr<const KeyRing> ring_of(const KeyEntry& entry) {
    KeyRing ring;
    EXPECT_TRUE(ring.add(entry));
    return std::make_shared<const KeyRing>(std::move(ring));
  }

  // The guest dances while it turns; the time only ends a test that has failed.
  bool dance_until(const std::function<bool()>& is_so) {
    const MonoTime given_up = mono_now() + Duration::s(200);
    bool so = is_so();
    for (; !so && mono_now() < given_up; so = is_so()) {
      const MonoTime now = mono_now();
      if (now >= next_pose) {
        next_pose = now + Duration::ms(16);
        link->send(guest("alice"), pose_number(++sequence, now, this_clock_id()), now);
      }
      for (ListingServer* server : {liar.get(), honest.get()})
        if (server != nullptr) server->tick(now);
      poller->run_once(Duration::ms(2));
    }
    return so;
  }
  // The link lapses, and dances on at the liar's.
  bool survives_goodbye() {
    liar->send_goodbye();
    if (!dance_until([&] { return !link->is_connected(); })) {
      ADD_FAILURE() << "the link takes no notice of the goodbye";
      return false;
    }
    const std::uint64_t before = liar->poses();
    return dance_until([&] { return link->is_connected() && liar->poses() >= before + 10; });
  }
  // Rounded up: a probe or a try may fall on either end.
  std::uint64_t ten_seconds_since_begin() const {
    return 1 + static_cast<std::uint64_t>((mono_now() - begin).as_seconds() / 10.0);
  }

  PrivateKey identity = PrivateKey::make();
  GuestKey key = key_of("any", KeyKind::kRoom);
  std::shared_ptr<const KeyRing> keys;
  std::unique_ptr<Poller> poller;
  std::unique_ptr<ListingServer> liar, honest;
  std::unique_ptr<Link> link;
  std::vector<Address> moves;
  std::uint32_t sequence = 0;
  MonoTime next_pose, begin;
};

TEST_F(LyingServer, AListedHostThatIsNoServerReceivesProbesOnly) {
  auto victim = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(victim);
  std::vector<std::size_t> sizes;
  poller->watch(victim->fd(), [&](MonoTime) {
    for (const UdpSocket::Datagram& datagram : victim->receive())
      sizes.push_back(datagram.bytes.size());
  });
  liar->list({victim->local_address()});
  ASSERT_TRUE(dance_until([&] { return !sizes.empty(); })) << "the probe";
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(survives_goodbye()) << i;
  EXPECT_LE(sizes.size(), ten_seconds_since_begin());
  for (const std::size_t size : sizes) EXPECT_EQ(size, seal::kOverhead + 1);
  EXPECT_TRUE(moves.empty());
  poller->unwatch(victim->fd());
}

// It answers probes, as any server does, but does not know the key.
TEST_F(LyingServer, AServerOfOthersReceivesFewHandshakesAndNoPose) {
  ServerOptions options;
  options.keys = ring_of(key_of("any", KeyKind::kRoom));
  const auto victim = Server::open(Address::loopback(0), options, *poller);
  ASSERT_TRUE(victim);
  const SealCounters& seen = (*victim)->door().counters();
  liar->list({(*victim)->local_address()});
  ASSERT_TRUE(dance_until([&] { return seen.datagrams_in > 0; })) << "the probe";
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(survives_goodbye()) << i;
  const std::uint64_t tens = ten_seconds_since_begin();
  const auto tries =
      static_cast<std::uint64_t>(std::ranges::count(moves, (*victim)->local_address()));
  EXPECT_GE(tries, 1u);
  EXPECT_LE(tries, 3 + tens);
  // Poses, voices and hellos of the link's session would count here, beside the probes.
  EXPECT_LE(seen.of(SealReject::kUnknownId), tens);
  EXPECT_EQ(seen.handshakes_done, 0u);
  RecordProperty("datagrams", std::to_string(seen.datagrams_in));
  RecordProperty("bytes", std::to_string(seen.bytes_in));
}

TEST_F(LyingServer, AnHonestListStillHandsALinkOnAndBack) {
  honest = std::make_unique<ListingServer>(Address::loopback(0), identity, keys, *poller);
  const Address home = liar->address(), other = honest->address();
  liar->list({other});
  honest->list({Address::loopback(1)});  // not the way back
  ASSERT_TRUE(dance_until([&] { return honest->datagrams() > 0; })) << "the probe";
  liar->send_goodbye();
  liar.reset();
  ASSERT_TRUE(dance_until([&] { return honest->poses() >= 20; }));
  EXPECT_EQ(link->server(), other);
  liar = std::make_unique<ListingServer>(home, identity, keys, *poller);
  honest->send_goodbye();
  honest.reset();
  ASSERT_TRUE(dance_until([&] { return liar->poses() >= 20; }));
  EXPECT_EQ(link->server(), home);
}

}  // namespace
}  // namespace dance
