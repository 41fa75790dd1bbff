// The datagram that the dance travels in, byte by byte.
#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"
#include "tunnel/wire_records.h"

namespace dance::wire {
namespace {

using Buffer = std::array<std::uint8_t, kMaxPlain>;
using Written = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 3> kPayload{7, 8, 9};
constexpr std::int64_t kBaseTicks = 0x123456789a;

Record example() {
  Record record;
  record.slot = 3;
  record.stream = 0x00170102;
  record.sequence = 0xfffffffe;
  record.capture_us = (kBaseTicks - 0x0203) * kTick_us;
  record.payload = kPayload;
  return record;
}

Written written(const RecordsHeader& header, const std::vector<std::pair<Record, bool>>& records) {
  Buffer out;
  ByteWriter writer(out);
  begin_records(header, writer);
  for (const auto& [record, is_narrow] : records)
    add_record(record, is_narrow, header.base_ticks, writer);
  EXPECT_TRUE(writer.ok());
  return {writer.written().begin(), writer.written().end()};
}

// The bytes that docs/wire-format.md shows: a change here is a new version of the format.
TEST(WireRecords, ADatagramLooksAsItIsDocumented) {
  RecordsHeader header;
  header.number = 0x0102;
  header.has_acks = true;
  header.acks.newest = 0x0304;
  header.acks.before = 0x05060708;
  ASSERT_TRUE(header.acks.excepts.try_push({9, 10}));
  ASSERT_TRUE(header.wants.try_push(11));
  header.has_records = true;
  header.base_ticks = kBaseTicks;
  Record with_ages = example();
  with_ages.published_age_us = 16 * 0x0405;
  with_ages.server_age_us = -100;
  const Written expected{
      18,                                  // type
      0x02, 0x01, 23,                      // number; acks, excepts, wants, records
      0x04, 0x03, 0x08, 0x07, 0x06, 0x05,  // acknowledged
      1,    9,    10,                      // but for slot 10 nine before
      1,    11,                            // wants slot 11
      0x9a, 0x78, 0x56,                    // base
      0x83, 0x03, 0x72, 0x02, 0x01, 0xfe, 0xff, 0xff, 0xff, 0x03, 0x02, 7, 8, 9,  // wide
      0x03, 0x83, 0x72, 0xfe, 0x03, 0x02,                                         // narrow
      0x05, 0x04, 0xfe, 0xff, 0xff, 0xff, 0x9c, 0xff, 0xff, 0xff, 7,    8, 9};    // with ages
  EXPECT_EQ(written(header, {{example(), false}, {with_ages, true}}), expected);
}

TEST(WireRecords, FeedbackLooksAsItIsDocumented) {
  RecordsHeader header;
  header.has_feedback = true;
  header.feedback.loss = 0x0102;
  header.feedback.in_a_row = 0x0506;
  header.feedback.round_trip = 0x0304;
  ASSERT_TRUE(header.feedback.guests.try_push({5, 6, 7, false, 0, 0}));
  ASSERT_TRUE(header.feedback.guests.try_push({8, 9, 10, true, 0x0b0c, 0x0d0e}));
  const Written expected{18, 0, 0, 8,    0x02, 0x01, 0x06, 0x05, 0x04, 0x03,
                         2,  // loss, in a row, round trip, guests
                         5,  6, 7, 0x88, 9,    10,   0x0c, 0x0b, 0x0e, 0x0d};
  EXPECT_EQ(written(header, {}), expected);
}

TEST(WireRecords, WhatIsForReceiversOfLessLooksAsItIsDocumented) {
  RecordsHeader header;
  header.has_feedback = header.has_records = true;
  header.base_ticks = kBaseTicks;
  GuestFeedback about{5, 6, 7, true, 0x0102, 0x0304};
  about.base_log2 = 2;
  about.still_log2 = 5;
  about.has_base_held = true;
  about.newest_base_held = 0x0506;
  about.base_held_before = 0x0708;
  ASSERT_TRUE(header.feedback.guests.try_push(about));
  Record told = example();
  told.is_kept = told.counts_left_out = true;
  told.left_out = 0x0a0b;
  Record sent = example();
  sent.is_base = sent.needs_no_other = true;
  const Written bytes = written(header, {{told, true}, {sent, true}});
  const Written expected{
      18,   0,    0,    24,   0,    0,    0,    0,    0,    0, 1,  // feedback and records
      0xc5, 6,    7,    0x02, 0x01, 0x04, 0x03,                    // held,
      0x5a, 0x06, 0x05, 0x08, 0x07,                                // spacings, base held
      0x9a, 0x78, 0x56,                                            // base
      0x03, 0x43, 0xc0, 0x0b, 0x0a, 0x72, 0xfe, 0x03, 0x02, 7, 8,
      9,    0x03, 0x43, 0x30, 0x72, 0xfe, 0x03, 0x02, 7,    8, 9};
  EXPECT_EQ(bytes, expected);
  ByteReader in(parse_opening(bytes)->body);
  const auto back = parse_records_header(in);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->feedback.guests[0], about);
  const auto first = parse_record(0, in), second = parse_record(0, in);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->is_kept && first->counts_left_out);
  EXPECT_EQ(first->left_out, told.left_out);
  EXPECT_TRUE(second->is_base && second->needs_no_other && !second->counts_left_out);
  for (const int wrong : {0x4a, 0x3a, 0x8a, 0x5e}) {
    Written changed = bytes;
    changed[18] = static_cast<std::uint8_t>(wrong);
    ByteReader damaged(parse_opening(changed)->body);
    EXPECT_EQ(parse_records_header(damaged).has_value(), wrong == 0x4a) << wrong;
  }
}

TEST(WireRecords, HeadersAreAsSmallAsTheySay) {
  RecordsHeader header;
  header.has_records = header.has_acks = true;
  header.base_ticks = kBaseTicks;
  const std::size_t empty = written(header, {}).size();
  EXPECT_EQ(empty, kRecordsHeader);
  EXPECT_EQ(written(header, {{example(), true}}).size() - empty, kNarrowRecordHeader + 3);
  EXPECT_EQ(written(header, {{example(), false}}).size() - empty, kWideRecordHeader + 3);
  const std::array<std::uint8_t, kMaxPayload> payload{};
  Record longest = example();
  longest.payload = payload;
  longest.capture_us = 0;
  longest.counts_left_out = true;
  longest.published_age_us = longest.sent_age_us = longest.server_age_us = INT32_MAX;
  EXPECT_EQ(written(header, {{longest, false}}).size() - empty, kMaxRecordHeader + kMaxPayload);
}

TEST(WireRecords, MessagesOfChannelsComeBack) {
  for (std::size_t size = 1; size <= kMaxPayload; ++size) {
    RecordsHeader header;
    header.has_records = true;
    const std::vector<std::uint8_t> payload(size, 7);
    Record record;
    record.kind = RecordKind::kChannel;
    record.slot = static_cast<std::uint8_t>(size % 64);
    record.channel = static_cast<std::uint8_t>(size % 8);
    record.stream = 0x0009'0000;
    record.sequence = 0xfffffff0u + static_cast<std::uint32_t>(size);
    record.payload = payload;
    const Written bytes = written(header, {{record, false}, {example(), false}});
    ByteReader in(parse_opening(bytes)->body);
    ASSERT_TRUE(parse_records_header(in));
    const auto back = parse_record(0, in);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->kind, RecordKind::kChannel);
    EXPECT_EQ(back->slot, record.slot);
    EXPECT_EQ(back->channel, record.channel);
    EXPECT_EQ(back->stream, record.stream);
    EXPECT_EQ(back->sequence, record.sequence);
    EXPECT_EQ(back->payload.size(), size);
    const auto next = parse_record(0, in);
    ASSERT_TRUE(next && in.is_exhausted());
    EXPECT_EQ(next->kind, RecordKind::kPose);
  }
}

// Those bits say something about poses, and never about messages.
TEST(WireRecords, AMessageOfAChannelHasNoFlagsOfPoses) {
  RecordsHeader header;
  header.has_records = true;
  const std::vector<std::uint8_t> payload(100, 7);
  Record plain;
  plain.kind = RecordKind::kChannel;
  plain.payload = payload;
  Record flagged = plain;
  flagged.needs_no_other = flagged.is_base = flagged.is_kept = flagged.counts_left_out = true;
  const Written bytes = written(header, {{plain, false}});
  EXPECT_EQ(written(header, {{flagged, false}}), bytes);
  const std::size_t begin = bytes.size() - payload.size() - 8;
  const auto parsed = [&](std::size_t at, std::uint8_t bit) {
    Written changed = bytes;
    changed[begin + at] = static_cast<std::uint8_t>(changed[begin + at] | bit);
    ByteReader in(std::span<const std::uint8_t>(changed).subspan(begin));
    return parse_record(0, in).has_value();
  };
  EXPECT_TRUE(parsed(0, 0));
  EXPECT_FALSE(parsed(1, 0x80)) << "ages";
  for (const std::uint8_t bit : std::array<std::uint8_t, 4>{0x10, 0x20, 0x40, 0x80})
    EXPECT_FALSE(parsed(2, bit)) << +bit;
}

TEST(WireRecords, WhatIsWrittenComesBack) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t now_us = 5'000'000'000 + static_cast<std::int64_t>(random.below(1u << 30));
    RecordsHeader header;
    header.number = static_cast<std::uint16_t>(random.next_u64());
    header.has_records = true;
    header.base_ticks = to_ticks(now_us);
    std::vector<std::uint8_t> payload(1 + random.below(kMaxPayload), 5);
    Record record = example();
    record.kind = i % 3 == 0 ? RecordKind::kHands : RecordKind::kPose;
    record.sequence = static_cast<std::uint32_t>(random.next_u64());
    record.stream = static_cast<std::uint32_t>(random.next_u64());
    record.capture_us =
        to_ticks(now_us - 2'000'000 + static_cast<std::int64_t>(random.below(3'000'000))) *
        kTick_us;
    if (i % 2 == 0) record.sent_age_us = static_cast<std::int32_t>(random.below(3'000'000)) - 500;
    record.payload = payload;
    const bool is_narrow = record.kind == RecordKind::kPose && i % 5 < 3;
    const Written bytes = written(header, {{record, is_narrow}});
    ByteReader in(parse_opening(bytes)->body);
    const auto back = parse_records_header(in);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->number, header.number);
    // The receiver's clock is not quite the sender's.
    const std::int64_t near_us =
        now_us + static_cast<std::int64_t>(random.below(200'000'000)) - 100'000'000;
    const std::int64_t base = base_us(back->base_ticks, near_us);
    EXPECT_EQ(base, header.base_ticks * kTick_us);
    auto read = parse_record(base, in);
    ASSERT_TRUE(read && in.is_exhausted());
    EXPECT_EQ(read->is_narrow, is_narrow);
    const auto before = record.sequence - 100 + static_cast<std::uint32_t>(random.below(200));
    ASSERT_TRUE(widen(static_cast<std::uint16_t>(record.stream >> 16), is_narrow, record.stream,
                      before, *read));
    EXPECT_EQ(read->kind, record.kind);
    EXPECT_EQ(read->stream, record.stream);
    EXPECT_EQ(read->sequence, record.sequence);
    EXPECT_EQ(read->capture_us, record.capture_us);
    EXPECT_NEAR(read->sent_age_us, record.sent_age_us, 8);
    EXPECT_EQ(read->payload.size(), payload.size());
  }
}

TEST(WireRecords, ANarrowRecordMeansNothingWithoutWhatCameBefore) {
  Record record = example();
  record.is_narrow = true;
  EXPECT_FALSE(widen(0x17, false, record.stream, record.sequence, record));
  EXPECT_FALSE(widen(0x18, true, record.stream, record.sequence, record)) << "another guest";
  EXPECT_FALSE(widen(0x17, true, record.stream + 1, record.sequence, record)) << "another stream";
  EXPECT_TRUE(widen(0x17, true, record.stream, record.sequence, record));
}

TEST(WireRecords, EveryPrefixAndEveryContradictionIsRefused) {
  RecordsHeader header;
  header.has_records = header.has_acks = header.has_feedback = true;
  ASSERT_TRUE(header.feedback.guests.try_push({8, 9, 10, true, 1, 1}));
  ASSERT_TRUE(header.acks.excepts.try_push({32, 63}));
  header.base_ticks = kBaseTicks;
  const Written bytes = written(header, {{example(), false}});
  const auto is_good = [](const Written& datagram) {
    ByteReader in(parse_opening(datagram)->body);
    if (!parse_records_header(in)) return false;
    while (in.remaining() > 0)
      if (!parse_record(0, in)) return false;
    return true;
  };
  EXPECT_TRUE(is_good(bytes));
  for (std::size_t size = kSessionHeader; size < bytes.size(); ++size)
    EXPECT_FALSE(is_good({bytes.begin(), bytes.begin() + static_cast<long>(size)})) << size;
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Written changed = bytes;
    changed[at] = value;
    return changed;
  };
  EXPECT_FALSE(is_good(with(3, 0x40 | bytes[3]))) << "a flag that nobody knows";
  EXPECT_FALSE(is_good(with(10, 0))) << "no exceptions, though it says so";
  EXPECT_FALSE(is_good(with(11, 33))) << "an exception out of the window";
  EXPECT_FALSE(is_good(with(12, 64))) << "no such slot";
}

}  // namespace
}  // namespace dance::wire
