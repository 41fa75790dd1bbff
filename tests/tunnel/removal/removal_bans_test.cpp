// Who is refused after a removal, and for how long.
#include "tunnel/server/core/removal_bans.h"

#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

constexpr MonoTime kNow = MonoTime::from_us(5'000'000);
using Guests = FixedList<GuestId, wire::kMaxGuestsPerLink>;

Guests guests_named(const char* name) {
  Guests guests;
  EXPECT_TRUE(guests.try_push(guest(name)));
  return guests;
}

struct Asker {
  Access access;
  Guests guests;
  std::uint64_t token = 1;
};

bool is_refused(const RemovalBans& bans, const Asker& asker, MonoTime now = kNow,
                const char* room = "salsa") {
  return bans.refused_until(guest(room), asker.token, asker.access, asker.guests, now).has_value();
}

TEST(RemovalBans, RefusesAKeyOfOneNameByItsName) {
  RemovalBans bans;
  bans.add(guest("salsa"), {guest("bob-2"), 77, guest("bob"), true}, kNow);
  EXPECT_TRUE(is_refused(bans, {{.name = guest("bob")}, guests_named("bob-3")}));
  EXPECT_TRUE(is_refused(bans, {{.name = guest("bob")}, {}})) << "nor does it listen";
  EXPECT_FALSE(is_refused(bans, {{.name = guest("alice")}, guests_named("alice")}));
  EXPECT_FALSE(is_refused(bans, {{.name = guest("bob"), .any_name = true}, guests_named("carla")}))
      << "a key of a room that bears the same name";
  EXPECT_FALSE(is_refused(bans, {{.name = guest("bob")}, guests_named("bob")}, kNow, "tango"));
  EXPECT_TRUE(is_refused(bans, {{.name = guest("alice")}, guests_named("alice"), 77}))
      << "that link";
}

TEST(RemovalBans, RefusesAKeyThatAllShareByTheNamesOfGuests) {
  RemovalBans bans;
  const Access all{.name = guest("key-of-room"), .any_name = true};
  bans.add(guest("salsa"), {guest("bob"), 77, {}, true}, kNow);
  EXPECT_TRUE(is_refused(bans, {all, guests_named("bob")}));
  EXPECT_FALSE(is_refused(bans, {all, guests_named("carla")}));
  EXPECT_FALSE(is_refused(bans, {all, {}})) << "who only listens has no name";
  EXPECT_TRUE(is_refused(bans, {all, {}, 77}));
  EXPECT_FALSE(is_refused(bans, {{.name = guest("bob")}, guests_named("bob")}))
      << "bob has a key of his own: the other was not his";
}

TEST(RemovalBans, EndByThemselvesAndAreBounded) {
  RemovalBans bans;
  const Access bob{.name = guest("bob")};
  bans.add(guest("salsa"), {guest("bob"), 7, guest("bob"), true}, kNow);
  EXPECT_TRUE(
      is_refused(bans, {bob, guests_named("bob")}, kNow + wire::kRemovedFor - Duration::ms(1)));
  EXPECT_FALSE(is_refused(bans, {bob, guests_named("bob")}, kNow + wire::kRemovedFor));
  for (std::size_t i = 0; i < 2 * RemovalBans::kMost; ++i) {
    const GuestId who = guest("g" + std::to_string(i));
    bans.add(guest("salsa"), {who, 100 + i, who, true},
             kNow + Duration::ms(static_cast<std::int64_t>(i)));
  }
  const auto of = [&](std::size_t i) {
    const GuestId who = guest("g" + std::to_string(i));
    return is_refused(bans, {{.name = who}, {}}, kNow + Duration::s(1));
  };
  EXPECT_FALSE(of(0)) << "the oldest made room";
  EXPECT_FALSE(of(RemovalBans::kMost - 1));
  EXPECT_TRUE(of(RemovalBans::kMost));
  EXPECT_TRUE(of(2 * RemovalBans::kMost - 1));
}

}  // namespace
}  // namespace dance
