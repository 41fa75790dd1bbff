// What a house can do in the session that an invitation opens, and what it cannot.
#include <gtest/gtest.h>

#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

KeyEntry invited(std::string_view name) {
  KeyEntry entry = key_of(name);
  entry.has_key = false;
  entry.invitation = InvitationKey{PresharedKey::make(), 2'000'000'000, InvitationState::kOpen};
  return entry;
}

std::string wish_for(const PresharedKey& key) {
  std::string text(1, static_cast<char>(seal::kBindingWish));
  text.append(key.bytes().begin(), key.bytes().end());
  return text;
}

struct Wished {
  std::uint64_t peer;
  std::string guest;
  PresharedKey lasting;
};

// A street whose server writes down what houses wish.
struct InvitingStreet : SealedStreet {
  explicit InvitingStreet(std::vector<KeyEntry> entries) : SealedStreet(std::move(entries)) {
    SealServer::Handlers handlers;
    handlers.on_datagram = [this](std::uint64_t peer, const KeyEntry& key, seal::Bytes plain,
                                  MonoTime, MonoTime) {
      heard.push_back({peer, std::string(key.name.view()), {plain.begin(), plain.end()}});
    };
    handlers.on_end = [this](std::uint64_t peer) { ended.push_back(peer); };
    handlers.on_binding = [this](std::uint64_t peer, const KeyEntry& key,
                                 const PresharedKey& lasting) {
      wished.push_back({peer, std::string(key.name.view()), lasting});
    };
    server = *SealServer::make(
        limits, keys, certificates, [this] { return random.next_u64(); }, std::move(handlers),
        sink);
  }
  House& add_invited(const KeyEntry& entry) {
    return add_house(std::string(seal::kInvitedPrefix) + std::string(entry.name.view()),
                     entry.invitation->key);
  }

  struct Sink final : DatagramSink {
    explicit Sink(InvitingStreet& of) : street(of) {}
    void send(const Address& to, std::span<const std::uint8_t> bytes) override {
      street.passing.push_back({false, to, {bytes.begin(), bytes.end()}});
    }
    InvitingStreet& street;
  } sink{*this};
  std::vector<Wished> wished;
};

TEST(SealedInvitation, NamesAKeyAndHearsTheAnswer) {
  const KeyEntry alice = invited("alice");
  InvitingStreet street({alice});
  auto& house = street.add_invited(alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  const PresharedKey lasting = PresharedKey::make();
  street.say(house, wish_for(lasting));
  street.run(Duration::ms(10));
  ASSERT_EQ(street.wished.size(), 1u);
  EXPECT_EQ(street.wished[0].guest, "alice");
  EXPECT_TRUE(street.wished[0].lasting == lasting);
  street.server->answer_binding(street.wished[0].peer, Binding::kUsed);
  street.run(Duration::ms(10));
  ASSERT_EQ(house.heard.size(), 1u);
  EXPECT_EQ(house.heard[0], std::string({static_cast<char>(seal::kBindingAnswer),
                                         static_cast<char>(Binding::kUsed)}));
}

TEST(SealedInvitation, OpensNoRoom) {
  const KeyEntry alice = invited("alice");
  InvitingStreet street({alice});
  auto& house = street.add_invited(alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  const std::string wish = wish_for(PresharedKey::make());
  // A key alone, which is random, may begin as another message does: one that does not.
  const std::string key(wish.size() - 1, 'x');
  for (const std::string& text :
       {std::string("hello"), key, wish.substr(0, 32), wish + "x", std::string("\0", 1)})
    street.say(house, text);
  street.run(Duration::ms(10));
  EXPECT_TRUE(street.heard.empty());
  EXPECT_TRUE(street.wished.empty());
  EXPECT_EQ(street.server->counters().of(SealReject::kMalformed), 5u);
}

TEST(SealedInvitation, ThePlainNameOpensNothingWithItsKey) {
  const KeyEntry alice = invited("alice"), bob = key_of("bob");
  InvitingStreet street({alice, bob});
  auto& plain = street.add_house("alice", alice.invitation->key);
  auto& uninvited = street.add_house("invited:bob", bob.key);
  auto& nobody = street.add_house("invited:", alice.invitation->key);
  auto& wrong = street.add_house("invited:alice", PresharedKey::make());
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
  const KeyEntry alice = invited("alice");
  InvitingStreet street({alice});
  // A guesser who takes a new session for each guess, and one address for all.
  for (int i = 0; i < 300; ++i) {
    auto& guesser = street.add_house("invited:alice", PresharedKey::make());
    guesser.address = *Address::resolve("192.0.2.7:" + std::to_string(2000 + i));
    guesser.client->tick(street.now);
  }
  street.run(Duration::ms(5));
  const SealCounters& counters = street.server->counters();
  EXPECT_LE(counters.handshakes_begun, 120u);
  EXPECT_GT(counters.of(SealReject::kStrangerRate), 0u);
  EXPECT_EQ(counters.handshakes_done, 0u);
}

TEST(SealedInvitation, ManySessionsOfOneLeaveTheGuestHerPlace) {
  KeyEntry alice = invited("alice");
  alice.key = PresharedKey::make();
  alice.has_key = true;
  alice.invitation->state = InvitationState::kUsed;
  InvitingStreet street({alice});
  auto& guest = street.add_house("alice", alice.key);
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
  KeyEntry alice = invited("alice");
  InvitingStreet street({alice});
  auto& house = street.add_invited(alice);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  KeyEntry bound = alice;
  bound.key = PresharedKey::make();
  bound.has_key = true;
  bound.invitation->state = InvitationState::kUsed;
  street.set_keys({bound});
  EXPECT_EQ(street.server->peer_count(), 1u);
  // The guest with her key stays while what is known of her invitation is forgotten.
  auto& guest = street.add_house("alice", bound.key);
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
  const KeyEntry alice = invited("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("invited:alice", alice.invitation->key);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  street.say(house, wish_for(PresharedKey::make()));
  street.run(Duration::ms(10));
  ASSERT_EQ(house.heard.size(), 1u);
  EXPECT_EQ(house.heard[0][1], static_cast<char>(Binding::kNotHere));
}

}  // namespace
}  // namespace dance
