// Who may do what, and listeners.
#include "tunnel/server/core/access.h"

#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

TEST(Access, AKeyBearsItsOwnNameAndThoseThatBeginWithItAndADash) {
  const Access alice{.name = guest("alice")};
  for (const char* own : {"alice", "alice-2", "alice-", "alice-and-bob"})
    EXPECT_TRUE(alice.may_use_name(guest(own))) << own;
  for (const char* other : {"alic", "alice2", "bob", "bob-alice"})
    EXPECT_FALSE(alice.may_use_name(guest(other))) << other;
  EXPECT_FALSE(alice.may_use_name(GuestId()));
  EXPECT_FALSE(Access{}.may_use_name(guest("-x"))) << "a key without a name bears none";
  EXPECT_TRUE((Access{.name = guest("salsa"), .any_name = true}.may_use_name(guest("bob"))));
  EXPECT_FALSE((Access{.role = Role::kListener, .any_name = true}.may_use_name(guest("bob"))));
}

TEST(Access, AKeyOpensOneRoomOrAll) {
  EXPECT_TRUE(Access{}.may_enter(guest("salsa")));
  EXPECT_TRUE((Access{.room = guest("salsa")}.may_enter(guest("salsa"))));
  EXPECT_FALSE((Access{.room = guest("salsa")}.may_enter(guest("salsa-2"))));
}

TEST(Access, WhatIsOneForTheRoomIsTheHostsWhereThereIsOne) {
  const auto with = [](Role role) { return Access{.role = role}; };
  for (const bool has_host : {false, true}) {
    EXPECT_TRUE(may_set_room_state(with(Role::kHost), has_host));
    EXPECT_EQ(may_set_room_state(with(Role::kGuest), has_host), !has_host);
    EXPECT_FALSE(may_set_room_state(with(Role::kListener), has_host));
  }
}

TEST(Access, AnyGuestSetsTheSongUntilAHostLocksIt) {
  const auto with = [](Role role) { return Access{.role = role}; };
  for (const bool is_locked : {false, true})
    for (const bool locks : {false, true}) {
      EXPECT_TRUE(may_set_song(with(Role::kHost), is_locked, locks));
      EXPECT_EQ(may_set_song(with(Role::kGuest), is_locked, locks), !is_locked && !locks);
      EXPECT_FALSE(may_set_song(with(Role::kListener), is_locked, locks));
    }
}

TEST(Access, ARoomKnowsWhetherAHostIsThere) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  const auto has_host = [&] { return tunnel.server().rooms()[0].has_host(); };
  EXPECT_FALSE(has_host());
  auto& host =
      tunnel.add_house("salsa", {"hanna"}, {}, {.name = guest("hanna"), .role = Role::kHost});
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(has_host());
  tunnel.seal_anew(host);
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(has_host());
  EXPECT_EQ(tunnel.server().rooms()[0].host_count, 1u) << "one host, through two sealed sessions";
  // The same house with a key that is a host's no more.
  host.access.role = Role::kGuest;
  tunnel.seal_anew(host);
  tunnel.run(Duration::ms(100));
  EXPECT_FALSE(has_host());
  host.access.role = Role::kHost;
  tunnel.seal_anew(host);
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(has_host());
  host.link->send_goodbye();
  host.is_running = false;
  tunnel.run(Duration::ms(100));
  EXPECT_FALSE(has_host());
  EXPECT_TRUE(a.link->is_connected());
}

LinkOptions listening() {
  LinkOptions options;
  options.listen_only = true;
  return options;
}

TEST(Listeners, HearEverybodyAndAreNoGuests) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.link_options = listening();
  auto& listener = tunnel.add_house("salsa", {}, {}, {.role = Role::kListener});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  EXPECT_TRUE(listener.link->is_connected());
  EXPECT_GE(listener.heard_of(guest("alice")), 50u);
  EXPECT_EQ(tunnel.server().guest_count(), 1u);
  EXPECT_EQ(tunnel.server().listener_count(), 1u);
  EXPECT_TRUE(a.link->remote_stats().empty()) << "nobody sees a listener";
  // A pose does not make a guest of it.
  tunnel.dance(listener, guest("lara"));
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(tunnel.server().guest_count(), 1u);
  EXPECT_GE(listener.link->counters().unrouted, 1u);
}

TEST(Listeners, AListenersKeyWithGuestsIsRefusedAndItsRecordsAreDropped) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"}, {}, {.name = guest("bob"), .role = Role::kListener});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::ms(300));
  EXPECT_TRUE(b.saw("refused 9 "));
  EXPECT_FALSE(b.link->is_connected());
  wire::RefusalNotice notice;
  notice.cause = wire::Refusal::kOnlyListens;
  EXPECT_NE(refusal_line(notice, guest("salsa")).find("--listen-only"), std::string::npos);

  tunnel.link_options = listening();
  auto& listener = tunnel.add_house("salsa", {}, {}, {.role = Role::kListener});
  dance.run(Duration::ms(300));
  wire::Record record;
  const std::array<std::uint8_t, 3> payload{1, 2, 3};
  record.payload = payload;
  record.capture_us = tunnel.now().since_zero_us();
  wire::RecordsHeader header;
  header.has_records = true;
  wire::RecordChain chain{record.capture_us};
  std::array<std::uint8_t, 100> bytes;
  ByteWriter out(bytes);
  wire::begin_records(header, out);
  wire::add_record(record, false, chain, out);
  tunnel.inject(listener.peer, out.written());
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kNotAllowed), 1u);
}

TEST(Listeners, HaveABoundOfTheirOwn) {
  ServerLimits limits;
  limits.listeners_per_room = 2;
  limits.guests_per_room = 1;
  SimulatedTunnel tunnel(limits);
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& first = tunnel.add_house("salsa", {});
  auto& second = tunnel.add_house("salsa", {});
  tunnel.run(Duration::ms(200));
  auto& third = tunnel.add_house("salsa", {});
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(a.link->is_connected() && first.link->is_connected() && second.link->is_connected());
  EXPECT_TRUE(third.saw("refused 10 "));
  // Who has a place keeps it through another sealed session, and gives it back.
  tunnel.seal_anew(first);
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(first.link->is_connected());
  second.link->send_goodbye();
  second.is_running = false;
  tunnel.run(Duration::s(2));
  EXPECT_TRUE(third.link->is_connected());
}

TEST(Access, AnExpiredKeyOpensNoRoomAndTheLinkGetsTheReason) {
  SimulatedTunnel tunnel;
  auto& late = tunnel.add_house("salsa", {"alice"}, {},
                                {.name = guest("alice"), .is_expired = true, .until_s = 1000});
  tunnel.run(Duration::ms(500));
  EXPECT_EQ(tunnel.server().session_count(), 0u);
  EXPECT_TRUE(late.saw("refused 14 "));
  wire::RefusalNotice notice;
  notice.cause = wire::Refusal::kKeyExpired;
  const std::string line = refusal_line(notice, guest("salsa"));
  EXPECT_NE(line.find("has expired"), std::string::npos) << line;
  EXPECT_NE(line.find("another invitation"), std::string::npos) << line;
}

TEST(Access, ASessionEndsWhenItsKeyExpires) {
  SimulatedTunnel tunnel;
  std::vector<std::string> causes;
  tunnel.server().set_on_audit([&](PeerId, const AuditEvent& event) {
    if (event.kind != AuditKind::kJoined) causes.emplace_back(event.cause);
  });
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, {.name = guest("alice")});
  auto& bob = tunnel.add_house("salsa", {"bob"}, {}, {.name = guest("bob")});
  tunnel.run(Duration::ms(600));
  ASSERT_EQ(tunnel.server().session_count(), 2u);
  alice.access.is_expired = true;
  tunnel.change_access(alice);
  tunnel.run(Duration::ms(1500));
  EXPECT_EQ(tunnel.server().session_count(), 1u);
  EXPECT_TRUE(bob.saw("-alice"));
  EXPECT_TRUE(alice.saw("refused 14 "));
  ASSERT_GE(causes.size(), 2u);
  EXPECT_EQ(causes[0], "key_expired");
  alice.access.is_expired = false;
  tunnel.seal_anew(alice);
  tunnel.run(Duration::s(3));
  EXPECT_EQ(tunnel.server().session_count(), 2u) << "with a key that is good again it comes back";
}

}  // namespace
}  // namespace dance
