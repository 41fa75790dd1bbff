#include "tunnel/wire.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance::wire {
namespace {

using Buffer = std::array<std::uint8_t, kMaxDatagram>;

Hello full_hello() {
  Hello hello;
  hello.nonce = 0x1122334455667788;
  hello.token = 0x99aabbccddeeff00;
  hello.link_time_us = -5;
  EXPECT_TRUE(hello.codecs.try_push({CodecId::kPlain, 0x01020304}));
  hello.room = *RoomName::parse("salsa-room-of-24-letters");
  for (std::size_t i = 0; i < kMaxGuestsPerLink; ++i)
    EXPECT_TRUE(hello.guests.try_push(
        *GuestId::parse("a-guest-with-24-letters" + std::string(1, static_cast<char>('a' + i)))));
  return hello;
}

TEST(Wire, TheLongestHelloFitsItsPaddingAndComesBackWhole) {
  Buffer out;
  const Hello hello = full_hello();
  ASSERT_EQ(build(hello, out), kHelloBytes);
  const auto opening = parse_opening({out.data(), kHelloBytes});
  ASSERT_TRUE(opening);
  EXPECT_TRUE(opening->has_magic);
  EXPECT_EQ(opening->type, Type::kHello);
  HelloProblem problem;
  const auto back = parse_hello(*opening, problem);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->nonce, hello.nonce);
  EXPECT_EQ(back->token, hello.token);
  EXPECT_EQ(back->link_time_us, -5);
  EXPECT_EQ(back->room, hello.room);
  ASSERT_EQ(back->codecs.size(), 1u);
  EXPECT_EQ(back->codecs[0], (CodecName{CodecId::kPlain, 0x01020304}));
  ASSERT_EQ(back->guests.size(), kMaxGuestsPerLink);
  EXPECT_EQ(back->guests[15], hello.guests[15]);
}

TEST(Wire, NoAnswerToAStrangerIsLongerThanAHello) {
  Welcome welcome;
  welcome.session = 77;
  for (std::size_t i = 0; i < kMaxGuestsPerLink; ++i)
    ASSERT_TRUE(welcome.slots.try_push({static_cast<std::uint8_t>(i), 9}));
  Buffer out;
  const std::size_t size = build(welcome, out);
  EXPECT_GT(size, 0u);
  EXPECT_LE(size, kHelloBytes);
  const auto back = parse_welcome(*parse_opening({out.data(), size}));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->slots.size(), kMaxGuestsPerLink);
  RefusalNotice refusal;
  refusal.guest = *GuestId::parse("a-guest-with-24-letters1");
  EXPECT_LE(build(refusal, out), kHelloBytes);
}

// The bytes that docs/wire-format.md shows: a change here is a new version of the format.
TEST(Wire, APingLooksAsItIsDocumented) {
  Ping ping;
  ping.sequence = 0x01020304;
  ping.link_time_us = 0x1112131415161718;
  ping.roster_version = 2;
  ping.round_trip_us = 3;
  ping.datagrams_received = 4;
  ping.poses_received = 5;
  ping.poses_lost = 6;
  Buffer out;
  const std::size_t size = build(0xa1a2a3a4a5a6a7a8, ping, out);
  const std::vector<std::uint8_t> expected{
      0xa8, 0xa7, 0xa6, 0xa5, 0xa4, 0xa3, 0xa2, 0xa1, 16,                      // session, type
      4,    3,    2,    1,    0x18, 0x17, 0x16, 0x15, 0x14, 0x13, 0x12, 0x11,  // sequence, time
      2,    0,    0,    0,    3,    0,    0,    0,    4,    0,    0,    0,     //
      5,    0,    0,    0,    6,    0,    0,    0};
  EXPECT_EQ(std::vector<std::uint8_t>(out.begin(), out.begin() + static_cast<long>(size)),
            expected);
}

TEST(Wire, AFullRosterPartFitsADatagram) {
  RosterPart part;
  part.version = 4;
  part.parts = 2;
  part.part = 1;
  part.first_slot = 32;
  part.slot_span = 32;
  for (std::uint8_t i = 0; i < 32; ++i)
    ASSERT_TRUE(part.entries.try_push(
        {{static_cast<std::uint8_t>(32 + i), i}, *GuestId::parse("a-guest-with-24-letters1")}));
  Buffer out;
  const std::size_t size = build(1, part, out);
  ASSERT_GT(size, 0u);
  const auto back = parse_roster(parse_opening({out.data(), size})->body);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->entries.size(), 32u);
  EXPECT_EQ(back->entries[31].slot.slot, 63);
}

TEST(Wire, ABadNameInAHelloIsToldFromDamage) {
  Buffer out;
  const Hello hello = full_hello();
  build(hello, out);
  // Magic, version, type, reserved, nonce, token, time, codec count, codec and its model, then the room's length.
  constexpr std::size_t kRoomText = 8 + 8 + 8 + 8 + 1 + 5 + 1;
  out[kRoomText] = 'S';
  HelloProblem problem;
  EXPECT_FALSE(parse_hello(*parse_opening({out.data(), kHelloBytes}), problem));
  EXPECT_TRUE(problem.is_bad_name);
  EXPECT_EQ(problem.nonce, hello.nonce);
  out[kRoomText - 1] = 255;
  problem = {};
  EXPECT_FALSE(parse_hello(*parse_opening({out.data(), kHelloBytes}), problem));
}

TEST(Wire, TheSameGuestTwiceInAHelloIsABadName) {
  Hello hello;
  hello.token = 1;
  ASSERT_TRUE(hello.codecs.try_push({CodecId::kPlain, 0x01020304}));
  hello.room = *RoomName::parse("r");
  ASSERT_TRUE(hello.guests.try_push(*GuestId::parse("a")));
  ASSERT_TRUE(hello.guests.try_push(*GuestId::parse("a")));
  Buffer out;
  build(hello, out);
  HelloProblem problem;
  EXPECT_FALSE(parse_hello(*parse_opening({out.data(), kHelloBytes}), problem));
  EXPECT_TRUE(problem.is_bad_name);
}

TEST(Wire, TrailingBytesAreRefused) {
  Buffer out{};
  const auto body_of = [&](std::size_t size) {
    return parse_opening({out.data(), size + 1})->body;
  };
  EXPECT_FALSE(parse_ping(body_of(build(1, Ping{}, out))));
  EXPECT_FALSE(parse_pong(body_of(build(1, Pong{}, out))));
  EXPECT_FALSE(parse_state_ack(body_of(build(1, StateAck{{}, StateKind::kSkeleton, 1}, out))));
  Welcome welcome;
  welcome.session = 3;
  EXPECT_FALSE(parse_welcome(*parse_opening({out.data(), build(welcome, out) + 1})));
}

TEST(Wire, ASessionIdNeverLooksLikeTheMagic) {
  EXPECT_FALSE(may_be_session_id(0));
  EXPECT_FALSE(may_be_session_id(0xabcdef0000000000 | kMagic));
  EXPECT_TRUE(may_be_session_id(1));
}

}  // namespace
}  // namespace dance::wire
