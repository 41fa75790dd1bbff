#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/base/random.h"
#include "formats/engine/segment_reader.h"
#include "formats/engine/segment_writer.h"
#include "tests/allocation_guard.h"
#include "tests/formats/engine/stored_poses.h"

namespace dance::engine {
namespace {

const GuestId kAlice = *GuestId::parse("alice");
const GuestId kBob = *GuestId::parse("bob");
constexpr MonoTime kNow = MonoTime::from_ns(kSomeTime_ns);

class SegmentTest : public testing::Test {
 protected:
  std::size_t show(const GuestId& guest, std::uint32_t number = 1) {
    const std::size_t slot = *writer_.reserve(guest);
    writer_.write(slot, numbered(number));
    writer_.show(slot);
    return slot;
  }
  Outcome newest(std::size_t slot, StoredPose& pose) {
    return reader_.newest(slot, reader_.generation(slot), pose, number_);
  }

  std::unique_ptr<Segment> segment_ = fresh_segment();
  SegmentWriter writer_{*segment_, kNow};
  ReadCounters counters_;
  SegmentReader reader_{*segment_, counters_};
  std::uint64_t number_ = 0;
};

TEST_F(SegmentTest, GivesOutWhatWasPutIn) {
  const std::size_t slot = show(kAlice, 7);
  StoredPose pose;
  ASSERT_EQ(newest(slot, pose), Outcome::kFine);
  EXPECT_TRUE(is_whole(pose));
  EXPECT_EQ(pose.sequence, 7u);
  GuestEntry entry;
  ASSERT_EQ(reader_.guest(slot, entry), Outcome::kFine);
  EXPECT_EQ(entry.id, kAlice);
  EXPECT_EQ(entry.newest_staged_ns, kSomeTime_ns + 7);
  EXPECT_FALSE(entry.has_hands || entry.has_skeleton);
  EXPECT_EQ(reader_.check(kSomeTime_ns), SegmentCheck::kFine);
}

TEST_F(SegmentTest, KeepsTheLastPosesOfADancerInOrder) {
  const std::size_t slot = show(kAlice, 0);
  for (std::uint32_t n = 1; n < 100; ++n) writer_.write(slot, numbered(n));
  const SegmentReader::Numbers all = reader_.poses_after(slot, 0);
  ASSERT_EQ(all.count, kMostPoses);
  for (std::uint64_t i = 0; i < all.count; ++i) {
    StoredPose pose;
    ASSERT_EQ(reader_.pose(slot, reader_.generation(slot), all.first + i, pose), Outcome::kFine);
    EXPECT_EQ(pose.sequence, 100 - kMostPoses + i);
  }
  EXPECT_EQ(reader_.poses_after(slot, all.first + 28).count, 2u);
  EXPECT_EQ(reader_.poses_after(slot, all.first + 30).count, 0u);
  EXPECT_EQ(reader_.poses_after(slot, ~std::uint64_t{0}).count, 31u) << "wraps to the beginning";
}

TEST_F(SegmentTest, NobodyTakesALeaversPoseForTheNextDancers) {
  const std::size_t slot = show(kAlice, 1);
  const std::uint32_t alices = reader_.generation(slot);
  writer_.release(slot);
  StoredPose pose;
  EXPECT_EQ(reader_.generation(slot), 0u);
  EXPECT_EQ(reader_.newest(slot, alices, pose, number_), Outcome::kNoGuest);
  // 63 others first: the slot that is free for longest.
  std::size_t again = kGuestSlots;
  for (std::size_t i = 0; i < kGuestSlots; ++i) again = show(kBob, 2);
  ASSERT_EQ(again, slot);
  EXPECT_EQ(reader_.newest(slot, alices, pose, number_), Outcome::kNoGuest);
  ASSERT_EQ(newest(slot, pose), Outcome::kFine);
  EXPECT_EQ(pose.sequence, 2u);
  EXPECT_EQ(reader_.poses_after(slot, 0).count, 1u) << "alice's poses are not bob's";
  EXPECT_FALSE(writer_.reserve(kAlice).has_value());
}

TEST_F(SegmentTest, ARestartedWriterTakesUpAnyMemory) {
  const std::size_t slot = show(kAlice, 1);
  const std::uint32_t generation = reader_.generation(slot);
  const std::uint64_t epoch = reader_.epoch();
  Random random(5);
  for (std::size_t damage = 0; damage < 2; ++damage) {
    if (damage > 0)
      for (std::size_t i = 0; i < sizeof(Segment); ++i)
        reinterpret_cast<unsigned char*>(segment_.get())[i] =
            static_cast<unsigned char>(random.below(256));
    SegmentWriter next(*segment_, kNow + Duration::s(1 + static_cast<std::int64_t>(damage)));
    EXPECT_EQ(reader_.check(kSomeTime_ns + 1'000'000'000), SegmentCheck::kFine);
    EXPECT_NE(reader_.epoch(), epoch);
    for (std::size_t i = 0; i < kGuestSlots; ++i) EXPECT_EQ(reader_.generation(i), 0u);
    const std::size_t again = *next.reserve(kAlice);
    next.write(again, numbered(3));
    next.show(again);
    EXPECT_NE(reader_.generation(slot), generation);
    StoredPose pose;
    ASSERT_EQ(newest(again, pose), Outcome::kFine);
    EXPECT_EQ(pose.sequence, 3u);
    EXPECT_EQ(reader_.poses_after(again, 0).count, 1u);
  }
}

TEST_F(SegmentTest, TellsWhenTheWriterIsGone) {
  EXPECT_EQ(reader_.check(kSomeTime_ns + kHeartbeatStays_ns), SegmentCheck::kFine);
  EXPECT_EQ(reader_.check(kSomeTime_ns + kHeartbeatStays_ns + 1), SegmentCheck::kNoWriter);
  writer_.update_heartbeat(kNow + Duration::s(2));
  EXPECT_EQ(reader_.check(kSomeTime_ns + kHeartbeatStays_ns + 1), SegmentCheck::kFine);
  writer_.close();
  EXPECT_EQ(reader_.check(kSomeTime_ns), SegmentCheck::kNoWriter);
}

TEST_F(SegmentTest, TellsDamageInEachFieldOfTheHeader) {
  SegmentHeader& header = segment_->header;
  const auto wrong = [&](auto& field, auto value, SegmentCheck wanted) {
    const auto right = field.load();
    field.store(value);
    EXPECT_EQ(reader_.check(kSomeTime_ns), wanted);
    field.store(right);
    EXPECT_EQ(reader_.check(kSomeTime_ns), SegmentCheck::kFine);
  };
  wrong(header.magic, std::uint64_t{0}, SegmentCheck::kNoWriter);
  wrong(header.magic, kMagic ^ 1, SegmentCheck::kDamaged);
  wrong(header.version, kVersion + 1, SegmentCheck::kWrongVersion);
  wrong(header.guest_slots, 65u, SegmentCheck::kDamaged);
  wrong(header.segment_bytes, ~std::uint64_t{0}, SegmentCheck::kDamaged);
  wrong(header.state, 0u, SegmentCheck::kNoWriter);
  wrong(header.state, 2u, SegmentCheck::kNoWriter);
  wrong(header.state, 3u, SegmentCheck::kDamaged);
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1},
                                  std::int64_t{0}, std::numeric_limits<std::int64_t>::max()})
    wrong(header.heartbeat_ns, time, SegmentCheck::kDamaged);
}

TEST_F(SegmentTest, RefusesEachValueOfAPoseThatCannotBe) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const auto refused = [&](auto&& damage) {
    StoredPose pose = numbered(1);
    damage(pose);
    EXPECT_FALSE(is_valid(pose));
    const std::size_t slot = *writer_.reserve(kAlice);
    writer_.write(slot, pose);
    writer_.show(slot);
    StoredPose read;
    const std::uint64_t before = counters_.damaged;
    EXPECT_EQ(newest(slot, read), Outcome::kDamaged);
    EXPECT_EQ(counters_.damaged, before + 1);
    writer_.release(slot);
  };
  EXPECT_TRUE(is_valid(numbered(1)));
  for (const float bad : {nan, infinite, 1e30f, 2.0f}) {
    for (std::size_t b = 0; b < kBoneCount; ++b)
      refused([&](StoredPose& pose) { pose.rotation_xyzw[b][1] = bad; });
    refused([&](StoredPose& pose) { pose.confidence = bad; });
  }
  refused([](StoredPose& pose) { std::memset(pose.rotation_xyzw, 0, sizeof pose.rotation_xyzw); });
  for (const float bad : {nan, infinite, -1001.0f})
    for (std::size_t i = 0; i < 3; ++i) refused([&](StoredPose& pose) { pose.hips_m[i] = bad; });
  refused([](StoredPose& pose) { pose.presence = ~0u; });
  refused([&](StoredPose& pose) { pose.music_beats = static_cast<double>(infinite); });
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::int64_t{0},
                                  std::numeric_limits<std::int64_t>::max()}) {
    refused([&](StoredPose& pose) { pose.capture_ns = time; });
    refused([&](StoredPose& pose) { pose.staged_ns = time; });
  }
  refused([](StoredPose& pose) { pose.lag_ns = std::numeric_limits<std::int64_t>::min(); });
  refused([](StoredPose& pose) { pose.staged_ns += 2 * kLongestLag_ns; });
}

TEST_F(SegmentTest, EndsWhateverTheNumbersOfARingSay) {
  const std::size_t slot = show(kAlice);
  StoredPose pose;
  for (const std::uint64_t newest_number :
       {std::uint64_t{1}, ~std::uint64_t{0}, ~std::uint64_t{0} - 1, std::uint64_t{1} << 63})
    for (const std::uint64_t first : {std::uint64_t{0}, ~std::uint64_t{0}, newest_number}) {
      segment_->guests[slot].poses.newest.store(newest_number);
      segment_->guests[slot].poses.first.store(first);
      EXPECT_NE(newest(slot, pose), Outcome::kFine);
      for (const std::uint64_t known : {std::uint64_t{0}, newest_number, ~std::uint64_t{0}})
        EXPECT_LE(reader_.poses_after(slot, known).count, kMostPoses);
    }
  EXPECT_GT(counters_.busy, 0u);
}

TEST_F(SegmentTest, AHalfWrittenEntryIsNeverGivenOut) {
  const std::size_t slot = show(kAlice, 1);
  const std::uint64_t number = segment_->guests[slot].poses.newest.load();
  segment_->guests[slot].poses.entries[number % kPoseRing].version.store(2 * number + 1);
  StoredPose pose;
  EXPECT_EQ(newest(slot, pose), Outcome::kBusy);
  EXPECT_EQ(counters_.retries, static_cast<std::uint64_t>(SegmentReader::kTries));
  writer_.write(slot, numbered(2));
  EXPECT_EQ(newest(slot, pose), Outcome::kFine);
}

TEST_F(SegmentTest, RefusesAGuestWhoseNameIsNone) {
  const std::size_t slot = show(kAlice);
  GuestEntry entry;
  for (const std::uint64_t word : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{0x1b5b}}) {
    segment_->guests[slot].id[0].store(word);
    EXPECT_EQ(reader_.guest(slot, entry), Outcome::kDamaged);
  }
}

TEST_F(SegmentTest, AllocatesNothing) {
  AllocationGuard guard;
  const std::size_t slot = show(kAlice);
  StoredPose pose;
  for (std::uint32_t n = 0; n < 100; ++n) {
    writer_.write(slot, numbered(n));
    EXPECT_EQ(newest(slot, pose), Outcome::kFine);
  }
  writer_.release(slot);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance::engine
