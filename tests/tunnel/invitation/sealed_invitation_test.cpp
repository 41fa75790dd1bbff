// What a house can do in the session that an invitation opens, and what it cannot.
#include <gtest/gtest.h>

#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

// `own` is the private key in the invitation.
GuestKey invited(std::string_view name) {
  GuestKey entry = key_of(name);
  entry.key = PublicKey();
  entry.has_key = false;
  entry.invitation = InvitationKey{entry.own.public_key(), 2'000'000'000, InvitationState::kOpen};
  return entry;
}

const std::string kBindingRequest(1, static_cast<char>(seal::kBindingRequest));

struct RequestedBinding {
  std::uint64_t peer;
  std::string guest;
  PublicKey house;
};

// A street whose server notes what houses request.
struct InvitingStreet : SealedStreet {
  explicit InvitingStreet(std::vector<KeyEntry> entries) : SealedStreet(std::move(entries)) {
    SealServer::Handlers handlers;
    handlers.on_datagram = [this](std::uint64_t peer, const KeyEntry& key, seal::Bytes plain,
                                  MonoTime, MonoTime) {
      heard.push_back({peer, std::string(key.name.view()), {plain.begin(), plain.end()}});
    };
    handlers.on_end = [this](std::uint64_t peer) { ended.push_back(peer); };
    handlers.on_binding = [this](std::uint64_t peer, const KeyEntry& key, const PublicKey& house) {
      requested.push_back({peer, std::string(key.name.view()), house});
    };
    server = *SealServer::make(
        limits, identity, keys, certificates, [this] { return random.next_u64(); },
        std::move(handlers), sink);
  }
  // Its last datagrams still go to the sink.
  ~InvitingStreet() { server.reset(); }
  House& add_invited(const GuestKey& entry, const PrivateKey& house = PrivateKey::make()) {
    return add_house(std::string(seal::kInvitedPrefix) + std::string(entry.name.view()), house,
                     entry.own);
  }

  struct Sink final : DatagramSink {
    explicit Sink(InvitingStreet& of) : street(of) {}
    void send(const Address& to, std::span<const std::uint8_t> bytes) override {
      street.passing.push_back({false, to, {bytes.begin(), bytes.end()}});
    }
    InvitingStreet& street;
  } sink{*this};
  std::vector<RequestedBinding> requested;
};

TEST(SealedInvitation, RequestsTheBindingOfItsIdentityAndReceivesTheAnswer) {
  const GuestKey alice = invited("alice");
  InvitingStreet street({alice});
  const PrivateKey identity_of_house = PrivateKey::make();
  auto& house = street.add_invited(alice, identity_of_house);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  street.say(house, kBindingRequest);
  street.run(Duration::ms(10));
  ASSERT_EQ(street.requested.size(), 1u);
  EXPECT_EQ(street.requested[0].guest, "alice");
  EXPECT_EQ(street.requested[0].house, identity_of_house.public_key());
  street.server->answer_binding(street.requested[0].peer, Binding::kUsed);
  street.run(Duration::ms(10));
  ASSERT_EQ(house.heard.size(), 1u);
  EXPECT_EQ(house.heard[0], std::string({static_cast<char>(seal::kBindingAnswer),
                                         static_cast<char>(Binding::kUsed)}));
}

TEST(SealedInvitation, OpensNoRoom) {
  const GuestKey alice = invited("alice");
  InvitingStreet street({alice});
  auto& house = street.add_invited(alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  for (const std::string& text : {std::string("hello"), kBindingRequest + "x",
                                  kBindingRequest + std::string(32, 'x'), std::string("\0", 1)})
    street.say(house, text);
  street.run(Duration::ms(10));
  EXPECT_TRUE(street.heard.empty());
  EXPECT_TRUE(street.requested.empty());
  EXPECT_EQ(street.server->counters().of(SealReject::kMalformed), 4u);
}

// Each request makes the server look into its key file.
TEST(SealedInvitation, RequestsOfOneSessionAreHandledEightTimesASecond) {
  const GuestKey alice = invited("alice");
  InvitingStreet street({alice});
  auto& house = street.add_invited(alice);
  street.run(Duration::ms(20));
  for (int i = 0; i < 1000; ++i) {
    street.say(house, kBindingRequest);
    street.run(Duration::ms(5));
    // Answers keep the link from making another session.
    street.server->answer_binding(street.requested.front().peer, Binding::kNotHere);
  }
  EXPECT_GE(street.requested.size(), 40u);
  EXPECT_LE(street.requested.size(), 8u + 41u);
  EXPECT_EQ(street.requested.size() + street.server->counters().of(SealReject::kControlRate),
            1000u);
}

TEST(SealedInvitation, ThePlainNameOpensNothingWithItsKey) {
  const GuestKey alice = invited("alice"), bob = key_of("bob");
  InvitingStreet street({alice, bob});
  const PrivateKey house_of_all = PrivateKey::make();
  auto& plain = street.add_house("alice", house_of_all, alice.own);
  auto& uninvited = street.add_house("invited:bob", house_of_all, bob.own);
  auto& nobody = street.add_house("invited:", house_of_all, alice.own);
  auto& wrong = street.add_house("invited:alice", house_of_all, PrivateKey::make());
  street.run(Duration::ms(100));
  for (auto* house : {&plain, &uninvited, &nobody, &wrong}) {
    EXPECT_EQ(house->sealed, 0);
    ASSERT_EQ(house->troubles.size(), 1u);
    EXPECT_EQ(house->troubles[0], SealTrouble::kWrongKey);
  }
  EXPECT_EQ(street.server->counters().of(SealReject::kUnknownName), 3u);
  EXPECT_EQ(street.server->counters().of(SealReject::kWrongKey), 1u);
}

TEST(SealedInvitation, GuessesAreThrottledAsThoseOfKeysAre) {
  const GuestKey alice = invited("alice");
  InvitingStreet street({alice});
  // A guesser takes a new session for each guess, and one address for all. Its first datagrams are
  // limited: 200 at once, and 100 a second.
  for (int i = 0; i < 300; ++i) {
    auto& guesser = street.add_house("invited:alice", PrivateKey::make(), PrivateKey::make());
    guesser.address = *Address::resolve("192.0.2.7:" + std::to_string(2000 + i));
    guesser.client->tick(street.now);
  }
  street.run(Duration::ms(5));
  const SealCounters& counters = street.server->counters();
  EXPECT_LE(counters.handshakes_begun, 200u);
  EXPECT_GT(counters.of(SealReject::kStrangerRate), 0u);
  EXPECT_EQ(counters.handshakes_done, 0u);
}

TEST(SealedInvitation, ManySessionsOfOneLeaveTheGuestHerPlace) {
  GuestKey alice = invited("alice");
  const PrivateKey house_of_alice = PrivateKey::make();
  alice.key = house_of_alice.public_key();
  alice.has_key = true;
  alice.invitation->state = InvitationState::kUsed;
  InvitingStreet street({alice});
  auto& guest = street.add_house("alice", house_of_alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(guest.sealed, 1);
  for (int i = 0; i < 12; ++i) street.add_invited(alice);
  street.run(Duration::ms(50));
  EXPECT_EQ(street.server->peer_count(), 1u + street.limits.peers_per_invitation);
  street.say(guest, "still here");
  street.run(Duration::ms(10));
  ASSERT_EQ(street.heard.size(), 1u);
  EXPECT_EQ(street.heard[0].text, "still here");
  // They do not stay for as long as a guest who is silent may.
  for (auto& house : street.houses) house->is_cut = true;
  street.run(Duration::s(12));
  EXPECT_EQ(street.server->peer_count(), 1u);
}

TEST(SealedInvitation, ItsSessionStaysWhenItIsUsedAndEndsWhenAnotherTakesItsPlace) {
  GuestKey alice = invited("alice");
  InvitingStreet street({alice});
  auto& house = street.add_invited(alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  KeyEntry bound = alice;
  const PrivateKey house_of_alice = PrivateKey::make();
  bound.key = house_of_alice.public_key();
  bound.has_key = true;
  bound.invitation->state = InvitationState::kUsed;
  street.set_keys({bound});
  EXPECT_EQ(street.server->peer_count(), 1u);
  // The guest with her key stays while what is known of her invitation is forgotten.
  auto& guest = street.add_house("alice", house_of_alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(guest.sealed, 1);
  EXPECT_EQ(street.server->peer_count(), 2u);
  bound.invitation.reset();
  street.set_keys({bound});
  EXPECT_EQ(street.server->peer_count(), 1u);
  street.say(guest, "still here");
  street.run(Duration::ms(10));
  EXPECT_EQ(street.heard.size(), 1u);
  street.set_keys({invited("alice")});
  EXPECT_EQ(street.server->peer_count(), 0u);
}

TEST(SealedInvitation, AServerThatTakesNoneSaysSo) {
  const GuestKey alice = invited("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("invited:alice", PrivateKey::make(), alice.own);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  street.say(house, kBindingRequest);
  street.run(Duration::ms(10));
  ASSERT_EQ(house.heard.size(), 1u);
  EXPECT_EQ(house.heard[0][1], static_cast<char>(Binding::kNotHere));
}

}  // namespace
}  // namespace dance
