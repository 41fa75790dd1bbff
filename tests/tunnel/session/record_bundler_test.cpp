// Records that share a datagram.
#include "tunnel/session/record_bundler.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance {
namespace {

constexpr MonoTime kBundleTime = MonoTime::from_us(5'000'000);

wire::Record record_of(std::uint8_t slot, std::uint32_t sequence, wire::Bytes payload) {
  wire::Record record;
  record.slot = slot;
  record.stream = 7;
  record.sequence = sequence;
  record.capture_us = wire::to_ticks(kBundleTime.since_zero_us() - 10'000) * wire::kTick_us;
  record.payload = payload;
  return record;
}

class RecordBundlerTest : public ::testing::Test {
 protected:
  void add(const wire::Record& record, MonoTime due) {
    bundle.add(record, false, kBundleTime.since_zero_us(), due);
  }
  std::vector<std::uint32_t> sequences_in(wire::Bytes datagram) {
    ByteReader in(datagram);
    const auto header = wire::parse_records_header(in);
    std::vector<std::uint32_t> sequences;
    if (!header) return sequences;
    for (wire::RecordChain chain{kBundleTime.since_zero_us()}; in.remaining() > 0;) {
      const auto record = wire::parse_record(chain, in);
      if (!record) return {};
      sequences.push_back(record->sequence);
    }
    return sequences;
  }

  std::array<std::uint8_t, 200> payload{};
  std::array<std::uint8_t, wire::kMaxPlain> buffer{};
  RecordBundler bundle;
};

TEST_F(RecordBundlerTest, WritesWhatItCollectedAndIsEmptyAgain) {
  for (std::uint32_t i = 1; i <= 3; ++i)
    add(record_of(static_cast<std::uint8_t>(i), i, {payload.data(), 20}), kBundleTime);
  wire::RecordsHeader header;
  header.has_records = true;
  EXPECT_EQ(sequences_in(bundle.write(header, buffer)), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_TRUE(bundle.is_empty());
  EXPECT_EQ(bundle.room(), wire::kMaxRecordsBody);
}

TEST_F(RecordBundlerTest, KeepsItsRecordsWhileAHeaderLeavesWithoutThem) {
  add(record_of(1, 1, {payload.data(), 20}), kBundleTime);
  EXPECT_TRUE(sequences_in(bundle.write({}, buffer)).empty());
  EXPECT_FALSE(bundle.is_empty());
}

TEST_F(RecordBundlerTest, TheFirstRecordDecidesWhenAllAreDue) {
  add(record_of(1, 1, {payload.data(), 20}), kBundleTime + Duration::ms(1));
  add(record_of(2, 1, {payload.data(), 20}), kBundleTime + Duration::ms(9));
  EXPECT_EQ(bundle.due(), kBundleTime + Duration::ms(1));
  EXPECT_FALSE(bundle.is_due(kBundleTime, 2));
  EXPECT_TRUE(bundle.is_due(kBundleTime + Duration::ms(1), 2));
}

TEST_F(RecordBundlerTest, IsDueWithAsManyPosesAsCanComeRepeatsNotCounted) {
  add(record_of(1, 1, {payload.data(), 20}), kBundleTime + Duration::ms(1));
  EXPECT_FALSE(bundle.is_due(kBundleTime, 1)) << "one that went before, once more";
  add(record_of(1, 2, {payload.data(), 20}), kBundleTime + Duration::ms(1));
  bundle.count_pose();
  EXPECT_TRUE(bundle.is_due(kBundleTime, 1));
  EXPECT_FALSE(bundle.is_due(kBundleTime, 2));
}

TEST_F(RecordBundlerTest, HasRoomForWhatFitsBesideTheLongestHeaderOfARecord) {
  std::uint32_t count = 0;
  while (bundle.has_room_for(record_of(1, count, payload)))
    add(record_of(1, ++count, payload), kBundleTime);
  EXPECT_GE(count, 4u);
  EXPECT_LT(bundle.room(), wire::kMaxRecordHeader + payload.size());
  wire::RecordsHeader header;
  header.has_records = true;
  EXPECT_EQ(sequences_in(bundle.write(header, buffer)).size(), count);
}

TEST(IsNarrowFor, OnlyAPoseLittleAheadOfWhatTheReceiverHasInItsStream) {
  FrameWindow frames;
  frames.add(7, 100);
  const std::array<std::uint8_t, 4> payload{};
  EXPECT_TRUE(is_narrow_for(frames, record_of(1, 101, payload)));
  EXPECT_TRUE(is_narrow_for(frames, record_of(1, 100 + wire::kNarrowReach, payload)));
  EXPECT_FALSE(is_narrow_for(frames, record_of(1, 101 + wire::kNarrowReach, payload)));
  EXPECT_FALSE(is_narrow_for(frames, record_of(1, 99, payload)));
  EXPECT_FALSE(is_narrow_for(FrameWindow(), record_of(1, 101, payload)));
  wire::Record other = record_of(1, 101, payload);
  other.stream = 8;
  EXPECT_FALSE(is_narrow_for(frames, other));
  other = record_of(1, 101, payload);
  other.kind = wire::RecordKind::kHands;
  EXPECT_FALSE(is_narrow_for(frames, other));
}

}  // namespace
}  // namespace dance
