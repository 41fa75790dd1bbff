// Voices byte by byte, and interest with what it says about voices.
#include <gtest/gtest.h>

#include <string_view>

#include "tests/tunnel/voice/voices.h"

namespace dance::wire {
namespace {

using Buffer = std::array<std::uint8_t, kMaxPlain>;
constexpr std::int64_t kNow_us = 5'000'000'000;

std::vector<std::uint8_t> datagram_of(const std::vector<VoiceRecord>& records) {
  Buffer buffer;
  ByteWriter out(buffer);
  begin_voices(out);
  for (const VoiceRecord& record : records) add_voice(record, out);
  return {out.written().begin(), out.written().end()};
}

std::vector<VoiceRecord> records_of(Bytes datagram, std::int64_t now_us = kNow_us) {
  const auto opening = parse_opening(datagram);
  EXPECT_EQ(opening->type, Type::kVoices);
  std::vector<VoiceRecord> records;
  for (ByteReader in(opening->body); in.remaining() > 0;) {
    const auto record = parse_voice(now_us, in);
    if (!record) return {};
    records.push_back(*record);
  }
  return records;
}

constexpr std::uint8_t kPacket[] = {0xf8, 0xff, 0xfe};

TEST(VoiceWire, IsByteForByteAsTheDocumentSays) {
  // 4,999,990,000 µs are 312,499,375 ticks, 0x12a05caf.
  const auto bytes = datagram_of({{{5, 0x0102}, 0xaabbccdd, kNow_us - 10'000, -23, kPacket}});
  const std::vector<std::uint8_t> golden{30,   5,    2,    1,  0xdd, 0xcc, 0xbb, 0xaa,
                                         0xaf, 0x5c, 0xa0, 23, 3,    0xf8, 0xff, 0xfe};
  EXPECT_EQ(bytes, golden);
  const auto back = records_of(golden);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].slot, (Slot{5, 0x0102}));
  EXPECT_EQ(back[0].sequence, 0xaabbccddu);
  EXPECT_EQ(back[0].capture_us, kNow_us - 10'000);
  EXPECT_EQ(back[0].level_dbfs, -23);
  EXPECT_TRUE(std::ranges::equal(back[0].packet, kPacket));
}

TEST(VoiceWire, TellsTheTimeWithinTwoMinutesOfNow) {
  for (const std::int64_t off_us : {-130'000'000LL, -5'000'000LL, -16LL, 0LL, 1'000'000LL}) {
    const auto bytes = datagram_of({{{0, 0}, 1, kNow_us + off_us, 0, kPacket}});
    // Whenever it is read, within a minute.
    for (const std::int64_t read_us : {kNow_us, kNow_us + 3'000'000})
      EXPECT_EQ(records_of(bytes, read_us).at(0).capture_us, kNow_us + off_us) << off_us;
  }
}

TEST(VoiceWire, ManyShareADatagram) {
  const std::vector<std::uint8_t> longest(kMaxVoiceBytes, 9);
  std::vector<VoiceRecord> records;
  for (std::uint8_t i = 0; i < 6; ++i)
    records.push_back(
        {{static_cast<std::uint8_t>(100 + i), i}, i, kNow_us, kSilence_dbfs, longest});
  const auto back = records_of(datagram_of(records));
  ASSERT_EQ(back.size(), 6u);
  EXPECT_EQ(back[5].slot, (Slot{105, 5}));
  EXPECT_EQ(back[5].packet.size(), kMaxVoiceBytes);
  EXPECT_EQ(back[5].level_dbfs, kSilence_dbfs);
}

TEST(VoiceWire, RefusesWhatIsNeverBuilt) {
  const auto good = datagram_of({{{5, 1}, 7, kNow_us, -23, kPacket}});
  ASSERT_EQ(records_of(good).size(), 1u);
  for (std::size_t size = 2; size < good.size(); ++size)
    EXPECT_TRUE(records_of({good.data(), size}).empty()) << size;
  const auto with = [&](std::size_t at, std::uint8_t byte) {
    auto bytes = good;
    bytes[at] = byte;
    return records_of(bytes).size();
  };
  EXPECT_EQ(with(1, 127), 1u);
  EXPECT_EQ(with(1, 128), 0u) << "no such slot";
  EXPECT_EQ(with(11, 127), 1u);
  EXPECT_EQ(with(11, 128), 0u) << "louder than full scale, or less than silence";
  EXPECT_EQ(with(12, 0), 0u) << "an empty packet";
  EXPECT_EQ(with(12, 2), 0u) << "a byte too many";
  std::vector<std::uint8_t> longer = good;
  longer[12] = 161;
  longer.resize(longer.size() + 158, 1);
  EXPECT_TRUE(records_of(longer).empty());
  longer[12] = 160;
  longer.pop_back();
  EXPECT_EQ(records_of(longer).size(), 1u);
}

InterestList with_voices(bool hears_others, const std::vector<Slot>& exceptions) {
  InterestList list;
  list.version = 9;
  EXPECT_TRUE(list.entries.try_push({{3, 4}, 2}));
  list.voices.hears_others = hears_others;
  for (const Slot& slot : exceptions) EXPECT_TRUE(list.voices.exceptions.try_push(slot));
  return list;
}

TEST(VoiceWire, InterestSaysNothingOfVoicesWhereAllAreWanted) {
  Buffer out;
  const auto size_of = [&](const InterestList& list) { return build(list, out); };
  EXPECT_EQ(size_of(with_voices(true, {})), 11u) << "as a version before wrote it";
  EXPECT_EQ(size_of(with_voices(false, {})), 13u);
  EXPECT_EQ(size_of(with_voices(true, {{3, 4}, {5, 6}})), 19u);
  const std::vector<std::uint8_t> golden{23, 9, 0, 0, 0, 1, 1, 3, 4, 0, 2, 0, 1, 5, 6, 0};
  const std::size_t size = size_of(with_voices(false, {{5, 6}}));
  EXPECT_TRUE(std::ranges::equal(std::span(out).first(size), golden));
  const auto back = parse_interest_list(parse_opening({out.data(), size})->body);
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->voices.hears_others);
  ASSERT_EQ(back->voices.exceptions.size(), 1u);
  EXPECT_EQ(back->voices.exceptions[0], (Slot{5, 6}));
}

TEST(VoiceWire, TheLongestInterestFitsIntoADatagram) {
  InterestList list;
  list.version = 1;
  list.voices.hears_others = false;
  for (std::uint8_t i = 0; i < kMaxGuestsPerRoom; ++i) {
    ASSERT_TRUE(list.entries.try_push({{i, i}, 3}));
    ASSERT_TRUE(list.voices.exceptions.try_push({i, i}));
  }
  Buffer out;
  const std::size_t size = build(list, out);
  ASSERT_GT(size, 0u);
  const auto back = parse_interest_list(parse_opening({out.data(), size})->body);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->voices, list.voices);
}

TEST(VoiceWire, InterestRefusesWhatIsNeverBuilt) {
  Buffer out;
  const std::size_t size = build(with_voices(false, {{5, 6}}), out);
  const auto is_good = [&](std::size_t length) {
    return parse_interest_list(parse_opening({out.data(), length})->body).has_value();
  };
  ASSERT_TRUE(is_good(size));
  EXPECT_TRUE(is_good(11)) << "nothing about voices";
  for (std::size_t length = 12; length < size; ++length) EXPECT_FALSE(is_good(length)) << length;
  EXPECT_FALSE(is_good(size + 1));
  out[13] = 128;
  EXPECT_FALSE(is_good(size)) << "no such slot";
  out[13] = 5;
  out[11] = 2;
  EXPECT_FALSE(is_good(size)) << "neither everybody nor nobody";
  out[11] = 1;
  out[12] = 0;
  EXPECT_FALSE(is_good(13)) << "all are wanted anyway";
}

}  // namespace
}  // namespace dance::wire
