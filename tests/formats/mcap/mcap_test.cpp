#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/byte_reader.h"
#include "formats/lz4/lz4_frame.h"
#include "formats/mcap/dance_schemas.h"
#include "tests/allocation_guard.h"
#include "tests/formats/mcap/mcap_sample.h"

namespace dance {
namespace {

Recording read(const McapBytes& bytes, bool* was_finished = nullptr) {
  Recording recording;
  auto reader = DanceMcapReader::over(bytes);
  EXPECT_TRUE(reader.has_value()) << reader.error().what;
  const auto result = reader->read_into(recording);
  EXPECT_TRUE(result.has_value()) << result.error().what;
  EXPECT_EQ(reader->counters().unreadable + reader->counters().invalid, 0u);
  EXPECT_EQ(reader->file().counters().lost(), 0u);
  if (was_finished) *was_finished = reader->file().was_finished();
  return recording;
}

// Of bytes that may be anything: how many poses, without a fault.
std::size_t poses_in(std::span<const std::uint8_t> bytes) {
  auto reader = DanceMcapReader::over(bytes);
  if (!reader) return 0;
  Recording recording;
  static_cast<void>(reader->read_into(recording));
  std::size_t poses = 0;
  for (const RecordedGuest& guest : recording.guests()) poses += guest.poses.size();
  return poses;
}

TEST(DanceMcap, GivesBackPosesHandsAndBeatsAsTheyWere) {
  const Recording night = recorded_night(150);
  bool was_finished = false;
  const Recording again = read(mcap_of(night), &was_finished);
  EXPECT_TRUE(was_finished);
  expect_same_poses(night, again);
  expect_same_hands_and_beats(night, again);
  for (const RecordedGuest& guest : night.guests())
    EXPECT_EQ(again.find(guest.guest)->skeleton(), guest.skeleton());  // to the last bit
}

TEST(DanceMcap, ReadsTheSameFromChunksWithoutCompressionAndWithoutChunks) {
  const Recording night = recorded_night(20);
  const McapBytes packed = mcap_of(night);
  for (const bool is_chunked : {true, false})
    expect_same_poses(night, read(plain_mcap_of(packed, is_chunked)));
}

TEST(DanceMcap, ReadsChunksThatAreCompressedWithLz4) {
  const Recording night = recorded_night(20);
  PlainMcapOptions options;
  options.compression = "lz4";
  options.pack = [](std::span<const std::uint8_t> bytes) {
    Lz4Packer packer(bytes.size());
    const auto frame =
        packer.pack({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, bytes.size());
    return std::vector<std::uint8_t>(frame->begin(), frame->end());
  };
  McapBytes packed = plain_mcap_of(mcap_of(night), options);
  expect_same_poses(night, read(packed));
  constexpr std::array<std::uint8_t, 4> kFrameMagic{0x04, 0x22, 0x4d, 0x18};
  const auto frame =
      std::search(packed.begin(), packed.end(), kFrameMagic.begin(), kFrameMagic.end());
  ASSERT_NE(frame, packed.end());
  frame[4] = 0xFF;  // its flags
  auto damaged = DanceMcapReader::over(packed);
  ASSERT_TRUE(damaged.has_value());
  Recording none;
  EXPECT_FALSE(damaged->read_into(none).has_value());
  EXPECT_EQ(damaged->file().counters().damaged_chunks, 1u);
}

TEST(DanceMcap, MergesChannelsThatFollowEachOtherByTheirLogTimes) {
  const Recording night = recorded_night(50);
  PlainMcapOptions options;
  options.by_channel = true;
  const McapBytes bytes = plain_mcap_of(mcap_of(night), options);
  auto reader = DanceMcapReader::over(bytes);
  ASSERT_TRUE(reader.has_value());
  Recording again;
  const auto done = reader->read_into(again);
  ASSERT_TRUE(done.has_value()) << done.error().what;
  EXPECT_TRUE(reader->was_sorted());
  EXPECT_EQ(reader->counters().bare + reader->counters().without_transforms, 0u);
  expect_same_poses(night, again);
}

TEST(DanceMcap, GoesOnBehindBytesThatAreNoRecordsAndCountsThem) {
  const Recording night = recorded_night(20);
  const McapBytes plain = plain_mcap_of(mcap_of(night), false);
  // Between two records, about in the middle.
  std::size_t at = kMcapMagic.size();
  while (at < plain.size() / 2)
    at += kMcapRecordHead_bytes + ByteReader(std::span(plain).subspan(at + 1)).u64();
  for (const std::uint8_t junk : std::initializer_list<std::uint8_t>{0x00, 0x55, 0xFF}) {
    McapBytes bytes = plain;
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), 4096, junk);
    auto reader = DanceMcapReader::over(bytes);
    ASSERT_TRUE(reader.has_value());
    Recording again;
    ASSERT_TRUE(reader->read_into(again).has_value());
    EXPECT_EQ(reader->file().counters().damaged_bytes, 4096u) << int{junk};
    expect_same_poses(night, again);
  }
}

TEST(DanceMcap, CountsARecordThatIsCutOff) {
  const McapBytes plain = plain_mcap_of(mcap_of(recorded_night(20)), false);
  McapBytes cut = plain;
  cut.resize(cut.size() - 5);
  McapReader reader = McapReader::over(cut).value();
  while (reader.next()) {
  }
  EXPECT_EQ(reader.counters().cut_records, 1u);
  EXPECT_EQ(reader.counters().lost(), 1u);
}

TEST(DanceMcap, KeepsTheChunksOfAWriterThatWasKilled) {
  const Recording night = recorded_night(20);
  McapBytes bytes = mcap_of(night, false);
  bool was_finished = true;
  expect_same_poses(night, read(bytes, &was_finished));
  EXPECT_FALSE(was_finished);
  bytes.resize(bytes.size() - 1);  // in the index behind the chunk
  expect_same_poses(night, read(bytes));
}

TEST(DanceMcap, DrawsABodyForEachGuestAndTakesAwayWhoIsSilent) {
  Recording night;
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    const Pose pose = night_pose(random, static_cast<std::uint32_t>(i));
    if (i < 2) night.on_pose(kAlice, pose, kNight_us + i * 1'000'000);
    night.on_pose(kBob, pose, kNight_us + i * 1'000'000);
  }
  const McapBytes bytes = mcap_of(night);
  McapReader reader = McapReader::over(bytes).value();
  std::size_t drawn = 0, taken_away = 0, floors = 0;
  while (const auto message = reader.next()) {
    if (message->schema != kSceneUpdateSchema.name) continue;
    const auto json = nlohmann::json::parse(message->data);
    floors += message->topic == kFloorTopic;
    if (message->topic != "/guest/alice/body") continue;
    drawn += json["entities"].size();
    taken_away += json["deletions"].size();
  }
  EXPECT_EQ(floors, 10u);
  EXPECT_EQ(taken_away, 1u);
  // In seconds 0, 1 and, until five of silence are over, in 2 to 5.
  EXPECT_EQ(drawn, 6u * kBoneCount);
}

TEST(DanceMcap, LeavesOutWhatHasNoTimeAndGuestsBeyondItsBound) {
  McapBytes bytes;
  DanceMcapWriter writer(put_into(bytes));
  writer.on_pose(kAlice, Pose(), -1);
  for (std::size_t i = 0; i < DanceMcapWriter::kMostGuests + 2; ++i)
    writer.on_pose(GuestId::parse("g" + std::to_string(i)).value(), Pose(), kNight_us);
  writer.finish();
  EXPECT_EQ(writer.counters().before_1970, 1u);
  EXPECT_EQ(writer.counters().beyond_guests, 3u);  // alice has a place
  EXPECT_EQ(writer.counters().poses, DanceMcapWriter::kMostGuests - 1);
}

TEST(DanceMcap, AllocatesNothingForAPose) {
  McapBytes bytes;
  bytes.reserve(1 << 24);
  DanceMcapWriter writer(put_into(bytes));
  Random random(5);
  const Pose pose = night_pose(random, 1);
  const Hands hands = night_hands(random, pose);
  const auto dance = [&](int second) {
    for (int i = 0; i < 200; ++i) {
      const std::int64_t us = kNight_us + second * 1'000'000 + i * 5000;
      writer.on_pose(kAlice, pose, us);
      writer.on_hands(kAlice, hands, us);
    }
  };
  dance(0);
  writer.end_chunk();
  const AllocationGuard guard;
  dance(1);  // with bodies and floor
  writer.end_chunk();
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(DanceMcap, IgnoresChannelsThatAreNotOurs) {
  const Recording night = recorded_night(5);
  McapBytes bytes;
  {
    McapWriter writer(put_into(bytes));
    const auto schema = writer.add_schema("foxglove.CompressedImage", "{}");
    const auto of_others = writer.add_schema(kFrameTransformsSchema.name, "{}");
    writer.write(writer.add_channel(schema, "/camera"), 1, 5, 5, "not even JSON");
    writer.write(writer.add_channel(of_others, "/tf"), 1, 5, 5, R"({"transforms":[]})");
    writer.end_chunk();
  }
  // Two files behind each other are no file; the second's records may follow without its magic.
  const McapBytes ours = mcap_of(night);
  McapReader reader = McapReader::over(ours).value();
  EXPECT_TRUE(reader.next().has_value());
  McapBytes only_theirs = bytes;
  auto nobody = DanceMcapReader::over(only_theirs);
  ASSERT_TRUE(nobody.has_value());
  Recording nothing;
  const auto result = nobody->read_into(nothing);
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().what.find("nobody dances in it"), std::string::npos);
  EXPECT_EQ(nobody->counters().unreadable, 0u);
}

// The same messages but for those that `change` leaves out with false, or writes anew.
McapBytes changed(const McapBytes& from,
                  const std::function<bool(const McapMessage&, std::string& data)>& change) {
  McapBytes bytes;
  McapWriter writer(put_into(bytes));
  McapReader reader = McapReader::over(from).value();
  std::map<std::string, std::uint16_t, std::less<>> channels;
  while (const auto message = reader.next()) {
    std::string data(message->data);
    if (!change(*message, data)) continue;
    auto channel = channels.find(message->topic);
    if (channel == channels.end()) {
      const std::string topic(message->topic);
      const auto schema = writer.add_schema(std::string(message->schema), "{}");
      channel = channels.emplace(topic, writer.add_channel(schema, topic)).first;
    }
    writer.write(channel->second, message->sequence, message->log_ns, message->publish_ns, data);
  }
  writer.finish();
  return bytes;
}

std::size_t poses_of(const Recording& night, const GuestId& guest) {
  const RecordedGuest* found = night.find(guest);
  return found ? found->poses.size() : 0;
}

TEST(DanceMcap, OneBadPoseCostsItselfAndNoneOfThoseThatFollow) {
  const Recording night = recorded_night(20);
  int seen = 0;
  const McapBytes bytes = changed(mcap_of(night), [&](const McapMessage& message, std::string& to) {
    if (message.topic != "/guest/alice/pose" || ++seen != 5) return true;
    auto json = nlohmann::json::parse(to);
    json["hips_height_m"] = 3.0;  // nobody is so tall
    to = json.dump();
    return true;
  });
  auto reader = DanceMcapReader::over(bytes).value();
  Recording again;
  ASSERT_TRUE(reader.read_into(again).has_value());
  EXPECT_EQ(reader.counters().invalid, 1u);
  EXPECT_EQ(poses_of(again, kAlice), 19u);
  EXPECT_EQ(poses_of(again, kBob), 20u);
  EXPECT_EQ(again.find(kAlice)->skeleton(), night.find(kAlice)->skeleton());
}

TEST(DanceMcap, CountsPosesWithoutTransformsAndTransformsWithoutPoses) {
  const McapBytes whole = mcap_of(recorded_night(20));
  int seen = 0;
  const McapBytes bytes = changed(whole, [&](const McapMessage& message, std::string&) {
    if (message.topic == "/guest/alice/transforms") return ++seen > 3;
    return message.topic != "/guest/bob/pose";
  });
  auto reader = DanceMcapReader::over(bytes).value();
  Recording again;
  ASSERT_TRUE(reader.read_into(again).has_value());
  EXPECT_EQ(reader.counters().without_transforms, 3u);
  EXPECT_EQ(reader.counters().bare, 20u);
  EXPECT_EQ(poses_of(again, kAlice), 17u);
  EXPECT_EQ(poses_of(again, kBob), 20u);
}

TEST(McapWriter, LeavesOutWhatIsTooLongAndCountsIt) {
  McapBytes bytes;
  McapWriter writer(put_into(bytes), 1000, 500);
  const auto channel = writer.add_channel(writer.add_schema("s", "{}"), "/t");
  writer.write(channel, 0, 1, 1, std::string(2000, 'x'));
  EXPECT_EQ(writer.left_out(), 1u);
  for (std::uint64_t i = 0; i < 20; ++i) writer.write(channel, 0, i, i, std::string(600, 'x'));
  writer.finish();
  EXPECT_GT(writer.left_out(), 1u);  // its index is full
  std::uint64_t found = 0;
  McapReader reader = McapReader::over(bytes).value();
  while (const auto message = reader.next()) found += message->data.size() == 600;
  EXPECT_EQ(found, writer.messages());
  EXPECT_EQ(found + writer.left_out(), 21u);
}

TEST(McapReader, ReadsAPrefixOfThePosesFromEachPrefixOfAFile) {
  const McapBytes packed = mcap_of(recorded_night(2));
  const std::size_t whole = poses_in(packed);
  ASSERT_EQ(whole, 4u);
  for (const McapBytes& bytes :
       {packed, plain_mcap_of(packed, true), plain_mcap_of(packed, false)}) {
    std::size_t before = 0;
    for (std::size_t size = 0; size <= bytes.size(); size += size < 600 ? 1 : 211) {
      const std::size_t poses = poses_in(std::span(bytes).first(size));
      ASSERT_GE(poses, before);
      ASSERT_LE(poses, whole);
      before = poses;
    }
  }
}

TEST(McapReader, SurvivesFlippedBitsAllOverAFile) {
  const McapBytes packed = mcap_of(recorded_night(1));
  for (std::size_t at = 0; at < packed.size(); at += 61) {
    McapBytes damaged = packed;
    damaged[at] ^= static_cast<std::uint8_t>(1u << (at % 8));
    ASSERT_LE(poses_in(damaged), 2u);
  }
  const McapBytes plain = plain_mcap_of(packed, true);
  for (std::size_t at = 0; at < plain.size(); at += 307) {
    McapBytes damaged = plain;
    damaged[at] ^= static_cast<std::uint8_t>(1u << (at % 8));
    ASSERT_LE(poses_in(damaged), 2u);
  }
}

// A chunk's head with these claims, and some bytes.
McapReader::Counters counters_of_chunk(std::uint64_t size, std::string_view compression,
                                       std::uint64_t packed_size, std::string_view packed,
                                       std::uint32_t crc = 0) {
  McapBytes bytes(kMcapMagic.begin(), kMcapMagic.end());
  McapRecord record;
  record.begin(McapOp::kChunk);
  record.u64(0);
  record.u64(0);
  record.u64(size);
  record.u32(crc);
  record.text(compression);
  record.u64(packed_size);
  for (const char c : packed) record.u8(static_cast<std::uint8_t>(c));
  record.end();
  bytes.insert(bytes.end(), record.bytes().begin(), record.bytes().end());
  McapReader reader = McapReader::over(bytes).value();
  EXPECT_FALSE(reader.next().has_value());
  return reader.counters();
}

TEST(McapReader, RefusesChunksThatClaimTooMuchAndCountsEachCause) {
  constexpr std::uint64_t kMax = ~std::uint64_t{0};
  EXPECT_EQ(counters_of_chunk(kMax, "zstd", 4, "abcd").oversized, 1u);
  EXPECT_EQ(counters_of_chunk(McapReader::kMostChunk_bytes, "zstd", 4, "abcd").oversized, 1u);
  EXPECT_EQ(counters_of_chunk(100, "zstd", kMax, "abcd").malformed, 1u);
  EXPECT_EQ(counters_of_chunk(100, "zstd", 4, "abcd").damaged_chunks, 1u);
  EXPECT_EQ(counters_of_chunk(0, "zstd", 0, "").lost(), 0u);
  EXPECT_EQ(counters_of_chunk(100, "lz4", 4, "abcd").damaged_chunks, 1u);
  EXPECT_EQ(counters_of_chunk(100, "lzo", 4, "abcd").other_compression, 1u);
  EXPECT_EQ(counters_of_chunk(4, "", 4, "abcd", 1).damaged_chunks, 1u);
  EXPECT_EQ(counters_of_chunk(4, "", 4, "abcd").malformed, 1u);
}

TEST(McapReader, ReadsNoFurtherThanARecordOfImpossibleLength) {
  McapBytes bytes = mcap_of(recorded_night(1), false);
  for (const int op : {0x03, 0x05, 0x06, 0x07, 0x80}) {
    McapBytes longer = bytes;
    longer.push_back(static_cast<std::uint8_t>(op));
    longer.insert(longer.end(), 8, 0xff);
    longer.insert(longer.end(), 100, 0);
    EXPECT_EQ(poses_in(longer), 2u);
  }
}

TEST(McapReader, SaysThatAFileIsNone) {
  const McapBytes text{'h', 'e', 'l', 'l', 'o', ' ', 'y', 'o', 'u'};
  const auto reader = DanceMcapReader::over(text);
  ASSERT_FALSE(reader.has_value());
  EXPECT_NE(reader.error().what.find("is no MCAP file"), std::string::npos);
  const auto missing = DanceMcapReader::open("/no/such/night.mcap");
  ASSERT_FALSE(missing.has_value());
  EXPECT_NE(missing.error().what.find("/no/such/night.mcap"), std::string::npos);
}

}  // namespace
}  // namespace dance
