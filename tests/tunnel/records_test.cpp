// The datagram that the dance travels in, byte by byte.
#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"
#include "tunnel/wire/wire_records.h"

namespace dance::wire {
namespace {

using Buffer = std::array<std::uint8_t, kMaxPlain>;
using Written = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 3> kPayload{7, 8, 9};
constexpr std::int64_t kNowTicks = 0x123456789a;
constexpr std::int64_t kNow_us = kNowTicks * kTick_us;

Record example() {
  Record record;
  record.slot = 3;
  record.stream = 0x00170102;
  record.sequence = 0xfffffffe;
  record.capture_us = (kNowTicks - 0x0203) * kTick_us;
  record.payload = kPayload;
  return record;
}

Written written(const RecordsHeader& header, const std::vector<std::pair<Record, bool>>& records) {
  Buffer out;
  ByteWriter writer(out);
  begin_records(header, writer);
  RecordChain chain{kNow_us};
  for (const auto& [record, is_narrow] : records) add_record(record, is_narrow, chain, writer);
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
  Record with_ages = example();
  with_ages.published_age_us = 16 * 0x0405;
  with_ages.server_age_us = -100;
  Record next = example();
  ++next.slot;
  next.capture_us += 5 * kTick_us;
  const Written expected{
      0x97, 0x02, 0x01,                    // acks, excepts, wants, records; number
      0x04, 0x03, 0x08, 0x07, 0x06, 0x05,  // acknowledged
      1,    9,    10,                      // but for slot 10 nine before
      1,    11,                            // wants slot 11
      3,    0x83, 0x72, 0x02, 0x01, 0xfe, 0xff, 0xff, 0xff, 0x97, 0x76, 0x56, 7, 8, 9,  // wide
      3,    0x03, 0x7e, 0xfe, 0xff, 0x00, 0x80,                                         // narrow
      0x05, 0x04, 0xfe, 0xff, 0xff, 0xff, 0x9c, 0xff, 0xff, 0xff, 7,    8,    9,        // with ages
      0x83, 0x7e, 5,    7,    8,    9};                                                 // brief
  EXPECT_EQ(written(header, {{example(), false}, {with_ages, true}, {next, true}}), expected);
}

TEST(WireRecords, FeedbackLooksAsItIsDocumented) {
  RecordsHeader header;
  header.has_feedback = true;
  header.feedback.loss = 0x0102;
  header.feedback.in_a_row = 0x0506;
  header.feedback.round_trip = 0x0304;
  ASSERT_TRUE(header.feedback.guests.try_push({5, 6, 7, false, 0, 0}));
  ASSERT_TRUE(header.feedback.guests.try_push({8, 9, 10, true, 0x0b0c, 0x0d0e}));
  const Written expected{0x88, 0, 0, 0x02, 0x01, 0x06, 0x05, 0x04, 0x03,
                         2,  // loss, in a row, round trip, guests
                         5,    6, 7, 0x88, 9,    10,   0x0c, 0x0b, 0x0e, 0x0d};
  EXPECT_EQ(written(header, {}), expected);
}

TEST(WireRecords, WhatIsForReceiversOfLessLooksAsItIsDocumented) {
  RecordsHeader header;
  header.has_feedback = header.has_records = true;
  GuestFeedback about{5, 6, 7, true, 0x0102, 0x0304};
  about.base_log2 = 2;
  about.intra_log2 = 5;
  about.has_base_acked = true;
  about.newest_base_acked = 0x0506;
  about.base_acked_before = 0x0708;
  ASSERT_TRUE(header.feedback.guests.try_push(about));
  Record told = example();
  told.is_retained = told.counts_left_out = true;
  told.left_out = 0x0a0b;
  Record sent = example();
  sent.is_base = sent.is_intra = true;
  const Written bytes = written(header, {{told, true}, {sent, true}});
  const Written expected{
      0x98, 0,    0,    0,    0,    0,    0,    0,    0,    1,  // feedback and records
      0xc5, 6,    7,    0x02, 0x01, 0x04, 0x03,                 // held,
      0x5a, 0x06, 0x05, 0x08, 0x07,                             // spacings, base held
      0x43, 0xc0, 0x03, 0x0b, 0x0a, 0x7e, 0x97, 0x76, 0x56, 7, 8,
      9,    0x43, 0x30, 0x03, 0x7e, 0x00, 0x80, 7,    8,    9};
  EXPECT_EQ(bytes, expected);
  ByteReader in(parse_opening(bytes)->body);
  const auto back = parse_records_header(in);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->feedback.guests[0], about);
  RecordChain chain{kNow_us};
  const auto first = parse_record(chain, in), second = parse_record(chain, in);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->is_retained && first->counts_left_out);
  EXPECT_EQ(first->left_out, told.left_out);
  EXPECT_TRUE(second->is_base && second->is_intra && !second->counts_left_out);
  for (const int wrong : {0x4a, 0x3a, 0x8a, 0x5e}) {
    Written changed = bytes;
    changed[17] = static_cast<std::uint8_t>(wrong);
    ByteReader damaged(parse_opening(changed)->body);
    EXPECT_EQ(parse_records_header(damaged).has_value(), wrong == 0x4a) << wrong;
  }
}

TEST(WireRecords, HeadersAreAsSmallAsTheySay) {
  RecordsHeader header;
  header.has_records = header.has_acks = true;
  const std::size_t empty = written(header, {}).size();
  EXPECT_EQ(empty, kRecordsHeader);
  const auto head_behind_another = [&](const Record& record, bool is_narrow) {
    Record other = example();
    other.slot = 60;
    return written(header, {{other, false}, {record, is_narrow}}).size() -
           written(header, {{other, false}}).size() - record.payload.size();
  };
  EXPECT_EQ(head_behind_another(example(), true), kNarrowRecordHeader);
  EXPECT_EQ(head_behind_another(example(), false), kWideRecordHeader);
  Record next = example();
  next.slot = 61;
  EXPECT_EQ(head_behind_another(next, true), kBriefRecordHeader);
  EXPECT_EQ(written(header, {{example(), true}}).size() - empty, kNarrowRecordHeader + 1 + 3);
  const std::array<std::uint8_t, kMaxPayload> payload{};
  Record longest = example();
  longest.payload = payload;
  longest.slot = kSlotsPerPage;
  longest.capture_us = 0;
  longest.counts_left_out = true;
  longest.published_age_us = longest.sent_age_us = longest.server_age_us = INT32_MAX;
  EXPECT_EQ(written(header, {{longest, false}}).size() - empty, kMaxRecordHeader + kMaxPayload);
}

// Two bytes lead to another page of slots, once for all that follow of it; the first page costs
// none, as in version 4.
TEST(WireRecords, AnotherPageOfSlotsCostsTwoBytes) {
  RecordsHeader header;
  header.has_records = true;
  Record low = example(), high = example(), next = example();
  low.slot = 9;
  high.slot = kSlotsPerPage + 20;
  next.slot = kSlotsPerPage + 21;
  const auto with = [&](const std::vector<std::pair<Record, bool>>& records) {
    return written(header, records).size();
  };
  const std::size_t payload = low.payload.size();
  const std::size_t one = with({{low, true}});
  EXPECT_EQ(with({{high, true}}), one + 2);
  EXPECT_EQ(with({{high, true}, {next, true}}), one + 2 + kBriefRecordHeader + payload);
  EXPECT_EQ(with({{low, true}, {high, true}, {low, true}}),
            one + 2 * (2 + kNarrowRecordHeader + payload));
}

// What is brief says the same as what is not.
TEST(WireRecords, ACrowdComesBackWhateverItsOrder) {
  Random random(9);
  std::size_t briefs = 0;
  for (int i = 0; i < 500; ++i) {
    RecordsHeader header;
    header.has_records = true;
    std::vector<std::pair<Record, bool>> crowd;
    constexpr int kSlots = kMaxGuestsPerRoom;
    auto slot = static_cast<std::uint8_t>(random.below(kSlots));
    for (int k = 0; k < 20; ++k) {
      Record record = example();
      slot = static_cast<std::uint8_t>((slot + (random.below(4) == 0 ? 5 : 1)) % kSlots);
      record.slot = slot;
      record.stream ^= static_cast<std::uint32_t>(random.below(2) << 16 | random.below(2));
      record.sequence += static_cast<std::uint32_t>(random.below(30));
      record.capture_us = kNow_us + (static_cast<std::int64_t>(random.below(300)) - 150) * kTick_us;
      if (random.below(8) == 0) record.capture_us -= 3'000'000 * kTick_us;
      if (random.below(8) == 0) record.sent_age_us = 160;
      if (random.below(8) == 0) record.is_intra = true;
      crowd.emplace_back(record, random.below(8) != 0);
    }
    const Written bytes = written(header, crowd);
    ByteReader in(parse_opening(bytes)->body);
    ASSERT_TRUE(parse_records_header(in));
    RecordChain chain{kNow_us + 1'000'000};
    for (const auto& [sent, is_narrow] : crowd) {
      const std::size_t before = in.remaining();
      auto read = parse_record(chain, in);
      ASSERT_TRUE(read);
      if (before - in.remaining() == kBriefRecordHeader + sent.payload.size()) ++briefs;
      EXPECT_EQ(read->is_narrow, is_narrow);
      ASSERT_TRUE(widen(static_cast<std::uint16_t>(sent.stream >> 16), true, sent.stream,
                        sent.sequence - kNarrowReach + static_cast<std::uint32_t>(random.below(48)),
                        *read));
      EXPECT_EQ(read->slot, sent.slot);
      EXPECT_EQ(read->stream, sent.stream);
      EXPECT_EQ(read->sequence, sent.sequence);
      EXPECT_EQ(read->capture_us, sent.capture_us);
      EXPECT_EQ(read->sent_age_us, sent.sent_age_us);
      EXPECT_EQ(read->is_intra, sent.is_intra);
    }
    EXPECT_TRUE(in.is_exhausted());
  }
  EXPECT_GT(briefs, 500u);
}

TEST(WireRecords, ABriefRecordMeansNothingWithoutOneBefore) {
  const std::array<std::uint8_t, 6> brief{0x83, 0x7e, 5, 7, 8, 9};
  const auto parsed_behind = [&](bool has_any, std::uint8_t first) {
    auto bytes = brief;
    bytes[0] = first;
    ByteReader in(bytes);
    RecordChain chain{kNow_us, has_any, 3, kNowTicks, 0};
    return parse_record(chain, in).has_value();
  };
  EXPECT_TRUE(parsed_behind(true, 0x83));
  EXPECT_FALSE(parsed_behind(false, 0x83));
  EXPECT_FALSE(parsed_behind(true, 0xc3)) << "brief ones are never long";
  EXPECT_FALSE(parsed_behind(true, 0x80)) << "nor empty";
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
    RecordChain chain{kNow_us};
    const auto back = parse_record(chain, in);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->kind, RecordKind::kChannel);
    EXPECT_EQ(back->slot, record.slot);
    EXPECT_EQ(back->channel, record.channel);
    EXPECT_EQ(back->stream, record.stream);
    EXPECT_EQ(back->sequence, record.sequence);
    EXPECT_EQ(back->payload.size(), size);
    const auto next = parse_record(chain, in);
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
  flagged.is_intra = flagged.is_base = flagged.is_retained = flagged.counts_left_out = true;
  const Written bytes = written(header, {{plain, false}});
  EXPECT_EQ(written(header, {{flagged, false}}), bytes);
  const std::size_t begin = bytes.size() - payload.size() - 8;
  const auto parsed = [&](std::size_t at, std::uint8_t bit) {
    Written changed = bytes;
    changed[begin + at] = static_cast<std::uint8_t>(changed[begin + at] | bit);
    ByteReader in(std::span<const std::uint8_t>(changed).subspan(begin));
    RecordChain chain;
    return parse_record(chain, in).has_value();
  };
  EXPECT_TRUE(parsed(0, 0));
  for (const std::uint8_t bit : std::array<std::uint8_t, 4>{0x10, 0x20, 0x40, 0x80})
    EXPECT_FALSE(parsed(1, bit)) << +bit;
}

TEST(WireRecords, WhatIsWrittenComesBack) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t now_us = 5'000'000'000 + static_cast<std::int64_t>(random.below(1u << 30));
    RecordsHeader header;
    header.number = static_cast<std::uint16_t>(random.next_u64());
    header.has_records = true;
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
    Buffer out;
    ByteWriter writer(out);
    begin_records(header, writer);
    RecordChain sent{now_us};
    add_record(record, is_narrow, sent, writer);
    ByteReader in(parse_opening(writer.written())->body);
    const auto back = parse_records_header(in);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->number, header.number);
    // The receiver's clock is not quite the sender's.
    RecordChain chain{now_us + static_cast<std::int64_t>(random.below(100'000'000)) - 50'000'000};
    auto read = parse_record(chain, in);
    ASSERT_TRUE(read && in.is_exhausted());
    EXPECT_EQ(read->is_narrow, is_narrow);
    const auto before =
        record.sequence - kNarrowReach + static_cast<std::uint32_t>(random.below(2 * kNarrowReach));
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

TEST(WireRecords, ANarrowRecordIsNeverFurtherAheadThanTheReach) {
  for (std::uint32_t behind = 0; behind <= 39; ++behind) {
    Record record = example();
    const std::uint32_t newest = record.sequence + behind;
    record.is_narrow = true;
    record.sequence &= 63;
    ASSERT_TRUE(widen(0x17, true, record.stream, newest, record));
    EXPECT_EQ(record.sequence, newest - behind) << behind;
  }
}

TEST(WireRecords, ACaptureThatNothingCanBeReckonedFromIsRefused) {
  for (const std::int64_t extreme : {INT64_MIN, INT64_MIN + 1, INT64_MAX - 8, INT64_MAX}) {
    std::array<std::uint8_t, 32> bytes{1, 0x83, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff};
    for (std::size_t i = 0; i < 8; ++i)
      bytes[12 + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(extreme) >> (8 * i));
    ByteReader in(std::span<const std::uint8_t>(bytes).first(21));
    RecordChain chain{kNow_us};
    EXPECT_FALSE(parse_record(chain, in)) << extreme;
  }
}

TEST(WireRecords, EveryPrefixAndEveryContradictionIsRefused) {
  RecordsHeader header;
  header.has_records = header.has_acks = header.has_feedback = true;
  ASSERT_TRUE(header.feedback.guests.try_push({8, 9, 10, true, 1, 1}));
  ASSERT_TRUE(header.acks.excepts.try_push({32, 63}));
  const Written bytes = written(header, {{example(), false}});
  const auto is_good = [](const Written& datagram) {
    ByteReader in(parse_opening(datagram)->body);
    if (!parse_records_header(in)) return false;
    for (RecordChain chain{kNow_us}; in.remaining() > 0;)
      if (!parse_record(chain, in)) return false;
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
  EXPECT_FALSE(is_good(with(0, 0x40 | bytes[0]))) << "a flag that nobody knows";
  EXPECT_FALSE(is_good(with(9, 0))) << "no exceptions, though it says so";
  EXPECT_FALSE(is_good(with(10, 33))) << "an exception out of the window";
  EXPECT_FALSE(is_good(with(11, kMaxGuestsPerRoom))) << "no such slot";
}

}  // namespace
}  // namespace dance::wire
