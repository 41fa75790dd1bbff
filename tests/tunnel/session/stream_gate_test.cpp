#include "tunnel/session/stream_gate.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/base/token_bucket.h"
#include "tunnel/link/core/link_guests.h"

namespace dance {
namespace {

using Verdict = StreamGate::Verdict;

TEST(StreamGate, LetsOnlyTheNewestThrough) {
  StreamGate gate;
  EXPECT_EQ(gate.judge(1, 10), Verdict::kNewStream);
  EXPECT_EQ(gate.judge(1, 11), Verdict::kNewest);
  EXPECT_EQ(gate.judge(1, 14), Verdict::kNewest);
  EXPECT_EQ(gate.counters().lost, 2u);
  EXPECT_EQ(gate.judge(1, 13), Verdict::kLate);
  EXPECT_EQ(gate.counters().lost, 1u) << "late is not lost";
  EXPECT_EQ(gate.judge(1, 13), Verdict::kDuplicate);
  EXPECT_EQ(gate.judge(1, 14), Verdict::kDuplicate);
  EXPECT_EQ(gate.counters().late, 1u);
  EXPECT_EQ(gate.counters().received, 3u);
}

TEST(StreamGate, WhatCameBeforeTheFirstIsNoLoss) {
  StreamGate gate;
  gate.judge(1, 10);
  gate.judge(1, 12);
  gate.judge(1, 9);
  EXPECT_EQ(gate.counters().lost, 1u);
}

TEST(StreamGate, WrapsWithItsSequence) {
  StreamGate gate;
  gate.judge(1, UINT32_MAX - 1);
  EXPECT_EQ(gate.judge(1, UINT32_MAX), Verdict::kNewest);
  EXPECT_EQ(gate.judge(1, 0), Verdict::kNewest);
  EXPECT_EQ(gate.judge(1, 2), Verdict::kNewest);
  EXPECT_EQ(gate.judge(1, UINT32_MAX), Verdict::kDuplicate);
  EXPECT_EQ(gate.judge(1, 1), Verdict::kLate);
  EXPECT_EQ(gate.counters().lost, 0u);
}

TEST(StreamGate, AStreamThatWasReplacedIsRefusedForGood) {
  StreamGate gate;
  gate.judge(0xffff0000, 500);
  EXPECT_EQ(gate.judge(0xffff0001, 1), Verdict::kNewStream);
  EXPECT_EQ(gate.judge(0xffff0000, 501), Verdict::kOldStream);
  EXPECT_EQ(gate.judge(0x00000000, 1), Verdict::kNewStream) << "generations wrap too";
  EXPECT_EQ(gate.judge(0xffff0001, 2), Verdict::kOldStream);
  EXPECT_EQ(gate.counters().lost, 0u);
}

TEST(StreamGate, ADamagedNumberHoldsAGuestUpForASecondAtMost) {
  StreamGate gate;
  gate.judge(1, 10, 5'000'000);
  EXPECT_EQ(gate.judge(1, 1'000'000'000, 5'010'000), Verdict::kNewest);
  EXPECT_EQ(gate.judge(1, 11, 5'020'000), Verdict::kLate);
  EXPECT_EQ(gate.judge(1, 72, 6'020'000), Verdict::kNewStream);
  EXPECT_EQ(gate.judge(1, 73, 6'036'000), Verdict::kNewest);
  EXPECT_EQ(gate.judge(9, 1, 4'000'000), Verdict::kLate) << "a new number on an old capture";
}

TEST(StreamGate, AccountsForEveryRecordOfAShuffledStream) {
  Random random(7);
  StreamGate gate;
  std::uint64_t offered = 0;
  std::uint64_t never_sent = 0;
  std::uint32_t block = 0;
  gate.judge(1, 0);
  for (int round = 0; round < 5000; ++round) {
    // Blocks of eight arrive in any order, some of them not at all.
    std::array<std::uint32_t, 8> order{};
    for (std::uint32_t i = 0; i < 8; ++i) order[i] = block + 1 + i;
    for (std::size_t i = 7; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
    for (const std::uint32_t sequence : order) {
      if (sequence != block + 8 && random.uniform() < 0.1) {
        ++never_sent;
        continue;
      }
      gate.judge(1, sequence);
      ++offered;
    }
    block += 8;
  }
  EXPECT_EQ(gate.counters().lost, never_sent);
  EXPECT_EQ(gate.counters().received + gate.counters().late, offered + 1);
}

TEST(StreamTag, TellsARestartFromAnOldPose) {
  const auto at = [](int ms) { return MonoTime::from_us(1'000'000) + Duration::ms(ms); };
  StreamTag tag;
  EXPECT_TRUE(tag.advance(5000, at(0), 1));
  EXPECT_TRUE(tag.advance(5001, at(16), 1));
  EXPECT_FALSE(tag.advance(5001, at(16), 1)) << "the same again";
  EXPECT_FALSE(tag.advance(5000, at(0), 1)) << "an older one";
  EXPECT_FALSE(tag.advance(5002, at(8), 1)) << "a count that goes on while its capture goes back";
  EXPECT_EQ(tag.restarts(), 0u);
  EXPECT_TRUE(tag.advance(1, at(32), 1));
  EXPECT_EQ(tag.restarts(), 1u);
  EXPECT_TRUE(tag.advance(100'000, at(48), 1)) << "a leap is another count";
  EXPECT_EQ(tag.restarts(), 2u);
  EXPECT_TRUE(tag.advance(100'001, at(10), 2)) << "another clock, another producer";
  EXPECT_EQ(tag.restarts(), 3u);
}

TEST(TokenBucket, AllowsTheBurstAndThenTheRate) {
  TokenBucket bucket(10.0, 5.0);
  MonoTime now = MonoTime::from_us(1);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(bucket.take(1.0, now));
  EXPECT_FALSE(bucket.take(1.0, now));
  now += Duration::ms(101);
  EXPECT_TRUE(bucket.take(1.0, now));
  EXPECT_FALSE(bucket.take(1.0, now));
  now += Duration::s(3600);
  int taken = 0;
  while (bucket.take(1.0, now)) ++taken;
  EXPECT_EQ(taken, 5);
}

TEST(RosterAssembly, IsWholeOnlyWithEveryPartOfOneVersion) {
  RosterAssembly roster;
  wire::RosterPart part;
  part.version = 3;
  part.parts = 2;
  EXPECT_TRUE(roster.take(part));
  EXPECT_EQ(roster.whole_version(), 0u);
  part.version = 4;
  part.part = 1;
  EXPECT_TRUE(roster.take(part));
  EXPECT_EQ(roster.whole_version(), 0u);
  part.version = 3;
  EXPECT_FALSE(roster.take(part)) << "overtaken";
  part.version = 4;
  part.part = 0;
  EXPECT_TRUE(roster.take(part));
  EXPECT_EQ(roster.whole_version(), 4u);
}

TEST(StreamGate, WhatWouldBeNewerButWasCapturedWellBeforeContradictsItself) {
  StreamGate gate;
  EXPECT_FALSE(gate.contradicts(5, 0)) << "nothing came before";
  gate.judge(1, 100, 5'000'000);
  EXPECT_TRUE(gate.contradicts(110, 4'300'000)) << "late by 54, read as ahead by 10";
  EXPECT_FALSE(gate.contradicts(110, 4'950'000)) << "clocks may be mapped anew";
  EXPECT_FALSE(gate.contradicts(100, 4'000'000));
  EXPECT_FALSE(gate.contradicts(90, 4'000'000)) << "late, and says so";
}

}  // namespace
}  // namespace dance
