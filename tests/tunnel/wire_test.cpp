#include "tunnel/wire/wire.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance::wire {
namespace {

using Buffer = std::array<std::uint8_t, kMaxPlain>;

Hello full_hello() {
  Hello hello;
  hello.nonce = 0x1122334455667788;
  hello.token = 0x99aabbccddeeff00;
  hello.link_time_us = -5;
  EXPECT_TRUE(hello.codecs.try_push({CodecId::kPlain, 0x01020304}));
  hello.room = *RoomName::parse("salsa-room-of-24-letters");
  hello.default_divider = 7;
  for (std::size_t i = 0; i < kMaxGuestsPerLink; ++i)
    EXPECT_TRUE(hello.guests.try_push(
        *GuestId::parse("a-guest-with-24-letters" + std::string(1, static_cast<char>('a' + i)))));
  return hello;
}

TEST(Wire, TheLongestHelloComesBackWhole) {
  Buffer out;
  Hello hello = full_hello();
  for (std::uint32_t i = 1; i < kMaxCodecs; ++i)
    ASSERT_TRUE(hello.codecs.try_push({CodecId::kLattice, i}));
  const std::size_t size = build(hello, out);
  ASSERT_GT(size, 0u);
  EXPECT_LE(size, kMaxHello);
  const auto opening = parse_opening({out.data(), size});
  ASSERT_TRUE(opening);
  EXPECT_EQ(opening->type, Type::kHello);
  HelloProblem problem;
  const auto back = parse_hello(opening->body, problem);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->nonce, hello.nonce);
  EXPECT_EQ(back->token, hello.token);
  EXPECT_EQ(back->link_time_us, -5);
  EXPECT_EQ(back->room, hello.room);
  EXPECT_EQ(back->default_divider, 7);
  ASSERT_EQ(back->codecs.size(), kMaxCodecs);
  EXPECT_EQ(back->codecs[0], (CodecName{CodecId::kPlain, 0x01020304}));
  ASSERT_EQ(back->guests.size(), kMaxGuestsPerLink);
  EXPECT_EQ(back->guests[15], hello.guests[15]);
}

TEST(Wire, NoAnswerToAHelloIsLongerThanTheLongest) {
  Welcome welcome;
  welcome.epoch = 77;
  for (std::size_t i = 0; i < kMaxGuestsPerLink; ++i)
    ASSERT_TRUE(welcome.slots.try_push({static_cast<std::uint8_t>(i), 9}));
  Buffer out;
  const std::size_t size = build(welcome, out);
  EXPECT_GT(size, 0u);
  EXPECT_LE(size, kMaxHello);
  const auto back = parse_welcome(parse_opening({out.data(), size})->body);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->slots.size(), kMaxGuestsPerLink);
  RefusalNotice refusal;
  refusal.guest = *GuestId::parse("a-guest-with-24-letters1");
  EXPECT_LE(build(refusal, out), kMaxHello);
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
  ping.epoch = 7;
  Buffer out;
  const std::size_t size = build(ping, out);
  const std::vector<std::uint8_t> expected{
      16,                                                           // type
      4,  3, 2, 1, 0x18, 0x17, 0x16, 0x15, 0x14, 0x13, 0x12, 0x11,  // sequence, time
      2,  0, 0, 0, 3,    0,    0,    0,    4,    0,    0,    0,     //
      5,  0, 0, 0, 6,    0,    0,    0,    7,    0,    0,    0};
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
  const std::size_t size = build(part, out);
  ASSERT_GT(size, 0u);
  const auto back = parse_roster(parse_opening({out.data(), size})->body);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->entries.size(), 32u);
  EXPECT_EQ(back->entries[31].slot.slot, 63);
}

TEST(Wire, ABadNameInAHelloIsToldFromDamage) {
  Buffer out;
  const Hello hello = full_hello();
  const std::size_t size = build(hello, out);
  // Type, version, nonce, token, time, codec count, codec and its model, then the room's length.
  constexpr std::size_t kRoomText = 1 + 1 + 8 + 8 + 8 + 1 + 5 + 1;
  out[kRoomText] = 'S';
  HelloProblem problem;
  EXPECT_FALSE(parse_hello(parse_opening({out.data(), size})->body, problem));
  EXPECT_TRUE(problem.is_bad_name);
  EXPECT_EQ(problem.nonce, hello.nonce);
  out[kRoomText - 1] = 255;
  problem = {};
  EXPECT_FALSE(parse_hello(parse_opening({out.data(), size})->body, problem));
}

TEST(Wire, TheSameGuestTwiceInAHelloIsABadName) {
  Hello hello;
  hello.token = 1;
  ASSERT_TRUE(hello.codecs.try_push({CodecId::kPlain, 0x01020304}));
  hello.room = *RoomName::parse("r");
  ASSERT_TRUE(hello.guests.try_push(*GuestId::parse("a")));
  ASSERT_TRUE(hello.guests.try_push(*GuestId::parse("a")));
  Buffer out;
  const std::size_t size = build(hello, out);
  HelloProblem problem;
  EXPECT_FALSE(parse_hello(parse_opening({out.data(), size})->body, problem));
  EXPECT_TRUE(problem.is_bad_name);
}

TEST(Wire, AnInterestLooksAsItIsDocumentedAndTheLongestComesBack) {
  InterestList list;
  list.version = 0x01020304;
  list.default_divider = 5;
  ASSERT_TRUE(list.entries.try_push({{6, 0x0708}, 9}));
  Buffer out;
  std::size_t size = build(list, out);
  const std::vector<std::uint8_t> expected{23, 4, 3, 2, 1, 5, 1, 6, 8, 7, 9};
  EXPECT_EQ(std::vector<std::uint8_t>(out.begin(), out.begin() + static_cast<long>(size)),
            expected);
  for (std::uint8_t i = 1; i < kMaxGuestsPerRoom; ++i)
    ASSERT_TRUE(list.entries.try_push({{i, i}, i}));
  size = build(list, out);
  const auto back = parse_interest_list(parse_opening({out.data(), size})->body);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->entries.size(), kMaxGuestsPerRoom);
  EXPECT_EQ(back->entries[63], list.entries[63]);
  EXPECT_EQ(back->version, list.version);
  out[6] = 65;
  EXPECT_FALSE(parse_interest_list(parse_opening({out.data(), size})->body));
  out[6] = 64;
  out[7] = 64;
  EXPECT_FALSE(parse_interest_list(parse_opening({out.data(), size})->body)) << "no such slot";
  out[7] = 6;
  std::fill_n(out.begin() + 1, 4, std::uint8_t{0});
  EXPECT_FALSE(parse_interest_list(parse_opening({out.data(), size})->body)) << "version 0";
  size = build_interest_ack(0x0a0b0c0d, out);
  EXPECT_EQ(parse_interest_ack(parse_opening({out.data(), size})->body), 0x0a0b0c0du);
}

TEST(Wire, TrailingBytesAreRefused) {
  Buffer out{};
  const auto body_of = [&](std::size_t size) {
    return parse_opening({out.data(), size + 1})->body;
  };
  EXPECT_FALSE(parse_ping(body_of(build(Ping{}, out))));
  EXPECT_FALSE(parse_pong(body_of(build(Pong{}, out))));
  Welcome welcome;
  welcome.epoch = 3;
  EXPECT_FALSE(parse_welcome(body_of(build(welcome, out))));
  EXPECT_FALSE(parse_refusal(body_of(build(RefusalNotice{}, out))));
  HelloProblem problem;
  const std::size_t size = build(full_hello(), out);
  EXPECT_TRUE(parse_hello(parse_opening({out.data(), size})->body, problem));
  EXPECT_FALSE(parse_hello(body_of(size), problem));
  EXPECT_FALSE(problem.is_bad_name);
}

TEST(Wire, AHelloOfAnotherVersionIsToldWithItsNonce) {
  Buffer out;
  const std::size_t size = build(full_hello(), out);
  out[1] = 77;
  HelloProblem problem;
  // Whatever else that version brings, or leaves out.
  EXPECT_FALSE(parse_hello(parse_opening({out.data(), size - 30})->body, problem));
  EXPECT_TRUE(problem.is_other_version);
  EXPECT_EQ(problem.nonce, full_hello().nonce);
}

}  // namespace
}  // namespace dance::wire
