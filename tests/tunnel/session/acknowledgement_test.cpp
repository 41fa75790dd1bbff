// The parts that acknowledgements are made of, and the choice that follows from them.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/base/random.h"
#include "tunnel/session/ack_window.h"
#include "tunnel/session/held_frames.h"
#include "tunnel/session/reference_policy.h"
#include "tunnel/session/sent_ring.h"

namespace dance {
namespace {

wire::Acks acks_of(const AckWindow& window) {
  wire::Acks acks;
  acks.newest = window.newest();
  acks.before = window.before();
  return acks;
}

TEST(AckWindow, SaysTheNewestAndThe32BeforeItThroughTheWrap) {
  AckWindow window;
  EXPECT_FALSE(window.has_any());
  window.note(65'530);
  EXPECT_EQ(window.before(), 0u) << "nothing came before the first";
  window.note(65'535);
  window.note(1);
  EXPECT_EQ(window.newest(), 1);
  EXPECT_EQ(window.before(), 1u << 1 | 1u << 6);
  window.note(0);
  EXPECT_EQ(window.before(), 1u << 0 | 1u << 1 | 1u << 6);
  EXPECT_TRUE(window.has(65'535));
  EXPECT_FALSE(window.has(65'534));
  window.note(40);
  EXPECT_EQ(window.before(), 0u);
  EXPECT_FALSE(window.covers(1));
}

TEST(AckWindow, CountsWhatNeverCame) {
  AckWindow window;
  Random random(3);
  std::uint64_t missing = 0;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    if (i > 0 && random.uniform() < 0.02) {
      ++missing;
      continue;
    }
    window.note(static_cast<std::uint16_t>(i));
  }
  EXPECT_NEAR(static_cast<double>(window.loss().lost()), static_cast<double>(missing), 5);
  EXPECT_NEAR(window.loss().loss(), 0.02, 0.012);
}

TEST(AckWindow, ADamagedNumberDoesNotStopItForLong) {
  AckWindow window;
  window.note(10);
  window.note(30'000);
  for (std::uint16_t i = 11; i < 30; ++i) window.note(i);
  EXPECT_EQ(window.newest(), 29);
}

TEST(HeldFrames, KeepsOneStreamAndWraps) {
  HeldFrames held;
  held.add(1, 65'535);
  held.add(1, 2);
  EXPECT_EQ(held.newest(), 2);
  EXPECT_TRUE(held.has(65'535));
  EXPECT_FALSE(held.has(0));
  held.add(1, 0);
  EXPECT_TRUE(held.has(0));
  held.add(2, 500);
  EXPECT_FALSE(held.has(2)) << "another stream";
  EXPECT_TRUE(held.is_of(2));
}

TEST(HeldFrames, TheIntersectionIsWhatBothHave) {
  Random random(8);
  for (int round = 0; round < 500; ++round) {
    HeldFrames a, b;
    const auto begin = static_cast<std::uint16_t>(random.next_u64());
    for (std::uint16_t i = 0; i < 50; ++i) {
      if (random.uniform() < 0.7) a.add(4, static_cast<std::uint16_t>(begin + i));
      if (random.uniform() < 0.7) b.add(4, static_cast<std::uint16_t>(begin + i));
    }
    HeldFrames both = a;
    both.intersect(b);
    for (std::uint16_t i = 0; i < 50; ++i) {
      const auto sequence = static_cast<std::uint16_t>(begin + i);
      EXPECT_EQ(both.bits() != 0 && both.has(sequence), a.has(sequence) && b.has(sequence));
    }
  }
  HeldFrames some, none;
  some.add(1, 5);
  some.intersect(none);
  EXPECT_EQ(some.bits(), 0u);
}

TEST(SentRing, AnAcknowledgementGivesTheFramesOfItsDatagramsOnce) {
  SentRing ring;
  AckWindow received;
  for (std::uint16_t i = 0; i < 10; ++i) {
    ring.add({1, i, 3});
    ring.add({1, static_cast<std::uint16_t>(100 + i), 4});
    EXPECT_EQ(ring.commit(true), i);
    if (i % 2 == 0) received.note(i);
  }
  wire::Acks acks = acks_of(received);
  ASSERT_TRUE(acks.excepts.try_push({2, 4}));
  std::multiset<std::uint16_t> held;
  const auto take = [&](const SentRing::Frame& frame) { held.insert(frame.sequence); };
  EXPECT_TRUE(ring.acknowledge(acks, take));
  EXPECT_EQ(held, (std::multiset<std::uint16_t>{0, 2, 4, 6, 8, 100, 102, 104, 108}));
  EXPECT_TRUE(ring.acknowledge(acks, take));
  EXPECT_EQ(held.size(), 9u);
}

TEST(SentRing, WhatWasNeverSentIsNotAcknowledged) {
  SentRing ring;
  int taken = 0;
  const auto take = [&](const SentRing::Frame&) { ++taken; };
  wire::Acks acks;
  acks.before = ~0u;
  EXPECT_FALSE(ring.acknowledge(acks, take)) << "nothing was sent at all";
  ring.add({1, 1, 1});
  ring.commit(true);
  for (const std::uint16_t newest : std::array<std::uint16_t, 4>{1, 255, 32'768, 65'535}) {
    acks.newest = newest;
    EXPECT_FALSE(ring.acknowledge(acks, take)) << newest;
  }
  EXPECT_EQ(taken, 0);
  acks.newest = 0;
  EXPECT_TRUE(ring.acknowledge(acks, take));
  EXPECT_EQ(taken, 1);
}

TEST(SentRing, GarbageDoesNothingBeyondWhatWasSent) {
  Random random(12);
  SentRing ring;
  std::uint32_t sent = 0;
  std::uint64_t taken = 0;
  for (int i = 0; i < 200'000; ++i) {
    if (random.below(3) == 0) {
      for (std::uint64_t k = random.below(20); k > 0; --k)
        ring.add({1, static_cast<std::uint16_t>(sent++), 2});
      ring.commit(true);
    }
    wire::Acks acks;
    acks.newest = static_cast<std::uint16_t>(random.next_u64());
    acks.before = static_cast<std::uint32_t>(random.next_u64());
    ring.acknowledge(acks, [&](const SentRing::Frame&) { ++taken; });
  }
  EXPECT_LE(taken, sent) << "each at most once";
}

TEST(SentRing, MeasuresLossThroughTheWrapOfItsNumbers) {
  SentRing ring;
  AckWindow received;
  Random random(5);
  for (int i = 0; i < 200'000; ++i) {
    const std::uint16_t number = ring.commit(true);
    if (random.uniform() >= 0.05) received.note(number);
    if (i % 4 == 0 && received.has_any())
      ring.acknowledge(acks_of(received), [](const SentRing::Frame&) {});
  }
  EXPECT_NEAR(static_cast<double>(ring.loss().lost()), 10'000.0, 400.0);
  EXPECT_NEAR(ring.loss().loss(), 0.05, 0.03);
}

// Feedback alone is not acknowledged: through a pause of the dance it would look like a way that is
// cut.
TEST(SentRing, WhatNobodyAnswersIsNotLost) {
  SentRing ring;
  AckWindow received;
  for (int i = 0; i < 10'000; ++i) {
    const bool has_records = i % 500 < 100;
    received.note(ring.commit(has_records));
    if (has_records) ring.acknowledge(acks_of(received), [](const SentRing::Frame&) {});
  }
  EXPECT_EQ(ring.loss().lost(), 0u);
}

TEST(LossMeter, WhatWasAssumedIsSoonForgotten) {
  LossMeter meter;
  for (int i = 0; i < 600; ++i) meter.add(false);
  EXPECT_LT(meter.loss(), 0.0011f);
  LossMeter lossy;
  for (int i = 0; i < 600; ++i) lossy.add(i % 10 == 0);
  EXPECT_NEAR(lossy.loss(), 0.1f, 0.02f);
}

TEST(LossMeter, OneLossInAThousandIsNotNoneAndABurstShowsAtOnce) {
  LossMeter clean;
  for (int i = 0; i < 20'000; ++i) clean.add(false);
  EXPECT_LT(clean.loss(), 0.0001f);
  LossMeter seldom;
  for (int i = 0; i < 20'000; ++i) seldom.add(i % 200 == 0);
  EXPECT_GT(seldom.loss(), 0.002f);
  for (int i = 0; i < 6; ++i) clean.add(true);
  EXPECT_GT(clean.loss(), 0.05f);
}

class Policy : public ::testing::Test {
 protected:
  References in(Duration later, double loss, Duration round_trip) {
    now += later;
    return policy.update(loss, loss * loss, round_trip, Duration::ms(16), now);
  }
  ReferencePolicy policy;
  MonoTime now = MonoTime::from_us(1);
  static constexpr Duration kShort = Duration::ms(30), kLong = Duration::ms(160);
};

TEST_F(Policy, BeginsWithThePreviousFrameTwice) {
  EXPECT_EQ(policy.current(), References::kPreviousTwice);
}

TEST_F(Policy, ChoosesByLossAndRoundTrip) {
  EXPECT_EQ(in({}, 0.02, kShort), References::kAcknowledged);
  EXPECT_EQ(in(Duration::s(2), 0.01, kLong), References::kPreviousTwice);
  EXPECT_EQ(in(Duration::s(2), 0.05, kLong), References::kAcknowledged);
  EXPECT_EQ(in(Duration::s(2), 0.0002, kLong), References::kPrevious);
  EXPECT_EQ(in(Duration::s(2), 0.0005, kShort), References::kPrevious);
}

TEST_F(Policy, TurnsToWhatReceiversHaveWhileTheyTellOfNothing) {
  in({}, 0.0002, kShort);
  ASSERT_EQ(policy.current(), References::kPrevious);
  const auto after = [&](int silence_ms, int frame_ms) {
    return policy.while_silent_for(Duration::ms(silence_ms), Duration::ms(frame_ms));
  };
  EXPECT_EQ(after(17, 16), References::kPrevious);
  EXPECT_EQ(after(100, 16), References::kPrevious);
  EXPECT_EQ(after(101, 16), References::kAcknowledged);
  EXPECT_EQ(after(130, 33), References::kPrevious) << "a slow dancer is told of seldom";
  EXPECT_EQ(after(133, 33), References::kAcknowledged);
  EXPECT_EQ(after(1999, 16), References::kAcknowledged);
  EXPECT_EQ(after(2000, 16), References::kPrevious) << "nobody will come back with these";
  EXPECT_EQ(policy.current(), References::kPrevious) << "the choice itself stands";
}

// Who misses what a frame refers to has it healed a round trip after the next that arrives. Losses
// of Gilbert's two states: by themselves, or several in a row.
TEST_F(Policy, OfWhatArrivesNearlyAllDecodesWhateverTheLine) {
  Random random(7);
  for (const double burst : {1.0, 3.0}) {
    for (const int round_trip : {1, 4, 10, 30}) {
      for (const double loss : {0.0001, 0.0005, 0.001, 0.005, 0.02, 0.05, 0.15}) {
        bool is_bad = false;
        const auto is_lost = [&] {
          const double ends = burst > 1.0 ? 1.0 / burst : 1.0 - loss;
          is_bad = random.uniform() < (is_bad ? 1.0 - ends : loss * ends / (1.0 - loss));
          return is_bad;
        };
        LossMeter meter;
        ReferencePolicy fresh;
        References chosen{};
        int in_a_row = 0, healed_at = -1, arrived = 0, missed = 0;
        for (int i = 0; i < 400'000; ++i) {
          if (i % 60 == 0)
            chosen = fresh.update(meter.loss(), meter.in_a_row(), Duration::ms(16) * round_trip,
                                  Duration::ms(16), MonoTime::from_us(1) + Duration::s(2) * i);
          const bool lost = is_lost();
          meter.add(lost);
          if (lost) {
            ++in_a_row;
            continue;
          }
          ++arrived;
          const int bears = chosen == References::kPrevious        ? 0
                            : chosen == References::kPreviousTwice ? 1
                                                                   : 1'000'000;
          if (in_a_row > bears && healed_at < i) healed_at = i + round_trip + 1;
          in_a_row = 0;
          missed += i < healed_at ? 1 : 0;
        }
        EXPECT_LT(missed, 0.006 * arrived)
            << round_trip << " frames, loss " << loss << ", " << burst << " in a row";
      }
    }
  }
}

TEST_F(Policy, DoesNotFlutter) {
  in({}, 0.01, kShort);
  int changes = 0;
  References last = policy.current();
  for (int i = 0; i < 100; ++i) {
    // To and fro across eight frames, and between what is borne and what is easily borne.
    const References next = in(Duration::ms(100), 0.01, Duration::ms(i % 2 == 0 ? 127 : 129));
    changes += next != last ? 1 : 0;
    last = next;
  }
  EXPECT_EQ(changes, 0);
  in(Duration::s(2), 0.0001, kShort);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(in(Duration::ms(100), i % 2 == 0 ? 0.0006 : 0.0009, kShort), References::kPrevious);
}

TEST_F(Policy, LeavesThePreviousFrameAloneAtOnceWhenSomethingIsLost) {
  EXPECT_EQ(in(Duration::s(2), 0.0, kShort), References::kPrevious);
  EXPECT_EQ(in(Duration::ms(1), 0.03, kShort), References::kAcknowledged);
  EXPECT_EQ(in(Duration::ms(1), 0.0, kShort), References::kAcknowledged) << "and stays";
}

}  // namespace
}  // namespace dance
