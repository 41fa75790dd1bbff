// What a packed log gives back, event by event, and what it costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/bus/channel.h"
#include "formats/log/log_packer.h"
#include "formats/log/log_unpacker.h"
#include "tests/allocation_guard.h"
#include "tests/formats/log/recorded_dance.h"

namespace dance {
namespace {

OwnEvents pack_all(LogPacker& packer, const OwnEvents& events) {
  OwnEvents packed;
  for (const OwnEvent& event : events) packed.emplace_back(packer.pack(event.event()));
  return packed;
}

OwnEvents unpack_all(LogUnpacker& unpacker, const OwnEvents& packed) {
  OwnEvents events;
  for (const OwnEvent& event : packed)
    if (const auto plain = unpacker.unpack(event.event())) events.emplace_back(*plain);
  return events;
}

// Gives what the events are packed.
OwnEvents expect_all_back(const OwnEvents& events) {
  LogPacker packer;
  LogUnpacker unpacker;
  OwnEvents packed = pack_all(packer, events);
  const OwnEvents back = unpack_all(unpacker, packed);
  EXPECT_EQ(back.size(), events.size());
  for (std::size_t i = 0; i < std::min(back.size(), events.size()); ++i)
    EXPECT_TRUE(back[i] == events[i]) << "event " << i << " on " << events[i].channel;
  EXPECT_EQ(unpacker.counters().lost(), 0u);
  EXPECT_EQ(unpacker.counters().unpacked, packer.counters().packed);
  return packed;
}

void put_big_endian(Bytes& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * (size - 1 - i)));
}

// pose_t as its .lcm file says: fingerprint, capture time, clock, six hops, sequence, presence, 92
// floats, music.
constexpr std::size_t kTimesAt = 8;
constexpr std::size_t kSequenceAt = kTimesAt + 8 * 8;
constexpr std::size_t kFloatsAt = kSequenceAt + 8;

TEST(PackedLog, AnEveningComesBackByteForByteInUnderHalfOfThem) {
  const OwnEvents evening = recorded_evening(600);
  LogPacker packer;
  pack_all(packer, evening);
  EXPECT_EQ(packer.counters().packed, 2400u);
  EXPECT_EQ(packer.counters().kept, 0u);
  EXPECT_LT(packer.counters().bytes, packer.counters().plain_bytes / 2);
  std::size_t plain = 0, stored = 0;
  const OwnEvents packed = expect_all_back(evening);
  for (const OwnEvent& event : evening) plain += event.event().stored_bytes();
  for (const OwnEvent& event : packed) stored += event.event().stored_bytes();
  EXPECT_EQ(packer.counters().plain_bytes, plain);
  EXPECT_EQ(packer.counters().bytes, stored);
}

TEST(PackedLog, NobodyWhoListensToPosesHearsAPackedOne) {
  for (const OwnEvent& event : expect_all_back(recorded_evening(10))) {
    if (event.channel.starts_with("SKELETON/")) continue;
    EXPECT_TRUE(event.channel.starts_with("PACKED/POSE/") ||
                event.channel.starts_with("PACKED/HANDS/"))
        << event.channel;
    EXPECT_FALSE(Channel::parse(event.channel));
    Pose pose;
    EXPECT_EQ(decode(event.data.data(), event.data.size(), pose), Decoded::kUndecodable);
  }
}

TEST(PackedLog, AnyBitsOfAPoseComeBack) {
  constexpr std::array<std::uint32_t, 12> kOdd{
      0x00000000, 0x80000000, 0x00000001, 0x807fffff,  // ±0, denormals
      0x7f800000, 0xff800000, 0x7f7fffff,              // infinite, largest
      0x7fc00000, 0x7f800001, 0xffffffff, 0xffc12345,  // not numbers, quiet and not
      0xbf800000};
  Random random(3);
  for (const double oddness : {0.01, 0.2, 1.0}) {
    OwnEvents events = recorded_evening(100);
    for (OwnEvent& event : events) {
      if (!event.channel.starts_with("POSE/")) continue;
      for (std::size_t at = kFloatsAt; at + 4 <= event.data.size(); at += 4)
        if (random.uniform() < oddness)
          put_big_endian(event.data, at, kOdd[random.below(kOdd.size())], 4);
      if (random.uniform() < oddness)
        put_big_endian(event.data, kSequenceAt, random.next_u64(), 8);  // presence too
    }
    expect_all_back(events);
  }
}

TEST(PackedLog, TimesThatNoClockShowsComeBack) {
  constexpr std::array<std::int64_t, 7> kTimes{INT64_MIN, INT64_MAX,     -1,       0,
                                               1,         INT64_MIN + 1, 1LL << 62};
  Random random(4);
  OwnEvents events = recorded_evening(200);
  for (OwnEvent& event : events) {
    event.time_us = kTimes[random.below(kTimes.size())];
    event.number = kTimes[random.below(kTimes.size())];
    if (!event.channel.starts_with("POSE/")) continue;
    for (std::size_t field = 0; field < 8; ++field)
      if (random.uniform() < 0.3)
        put_big_endian(event.data, kTimesAt + 8 * field,
                       static_cast<std::uint64_t>(kTimes[random.below(kTimes.size())]), 8);
  }
  expect_all_back(events);
}

TEST(PackedLog, NoiseIsKeptAsItIsAndCounted) {
  OwnEvents events = recorded_evening(40);
  Random random(5);
  for (std::size_t i = 0; i < events.size(); ++i)
    if (i % 40 > 20 && events[i].channel.starts_with("POSE/"))
      for (std::size_t at = kTimesAt; at < events[i].data.size(); ++at)
        events[i].data[at] = static_cast<std::uint8_t>(random.next_u64());
  LogPacker packer;
  const OwnEvents packed = pack_all(packer, events);
  EXPECT_GT(packer.counters().kept, 0u);
  for (std::size_t i = 0; i < events.size(); ++i)
    EXPECT_LE(packed[i].event().stored_bytes(), events[i].event().stored_bytes());
  expect_all_back(events);
}

TEST(PackedLog, WhatIsNoPoseGoesThroughUntouched) {
  Random random(1);
  const Bytes pose = bytes_of(recorded_pose(0, random));
  Bytes longer = pose, shorter = pose, stranger = pose;
  longer.push_back(0);
  shorter.pop_back();
  stranger[7] ^= 1;  // another fingerprint
  OwnEvents events;
  for (const Bytes& data : {Bytes{}, longer, shorter, stranger, bytes_of(Stats()), Bytes(5000, 7)})
    events.emplace_back(1, 2, "POSE/capture/alice", data);
  LogPacker packer;
  EXPECT_TRUE(pack_all(packer, events) == events);
  EXPECT_EQ(packer.counters().packed + packer.counters().kept, 0u);
  expect_all_back(events);
}

TEST(PackedLog, AChannelNameThatCannotGrowKeepsItsPosesPlain) {
  OwnEvents events;
  Random random(1);
  for (const std::size_t length : {1u, 56u, 57u, 63u})
    events.emplace_back(0, 0, std::string(length, 'x'), bytes_of(recorded_pose(0, random)));
  const OwnEvents packed = expect_all_back(events);
  EXPECT_EQ(packed[1].channel.size(), 63u);
  EXPECT_TRUE(packed[2] == events[2]);
  EXPECT_TRUE(packed[3] == events[3]);
}

// Somebody plays a packed log onto the bus while a packed recording is made.
TEST(PackedLog, PackedEventsThatWereOnTheBusComeBackPacked) {
  OwnEvents heard = expect_all_back(recorded_evening(5));
  heard.emplace_back(9, 9, "PACKED/" + std::string(56, 'x'), heard.front().data);
  heard.emplace_back(9, 9, "PACKED/", heard.front().data);
  heard.emplace_back(9, 9, "PACKED/POSE/capture/alice", Bytes{'D', 'P'});
  const OwnEvents twice = expect_all_back(heard);
  expect_all_back(twice);
}

TEST(PackedLog, EachChannelHasAnIntraFrameEachHalfSecondAndWhenTheClockIsSetBack) {
  Random random(1);
  LogPacker packer;
  std::vector<std::uint32_t> keys;
  std::int64_t time_us = kEvening_us;
  for (std::uint32_t i = 0; i < 90; ++i, time_us += 16'667) {
    if (i == 75) time_us -= 3'600'000'000;
    const Bytes pose = bytes_of(recorded_pose(i, random));
    const std::uint64_t before = packer.counters().intra_frames;
    packer.pack({0, time_us, "POSE/capture/alice", pose});
    if (packer.counters().intra_frames != before) keys.push_back(i);
  }
  EXPECT_EQ(keys, (std::vector<std::uint32_t>{0, 30, 60, 75}));
}

TEST(PackedLog, MoreChannelsThanItKeepsAllComeBack) {
  Random random(1);
  OwnEvents events;
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::size_t channel = 0; channel < kMaxMotionStreams + 20; ++channel)
      events.emplace_back(0, kEvening_us, "POSE/capture/guest-" + std::to_string(channel),
                          bytes_of(recorded_pose(i, random)));
  expect_all_back(events);
}

TEST(PackedLog, OneRecordingBehindAnotherComesBack) {
  const OwnEvents first = recorded_evening(20, 1), second = recorded_evening(20, 2);
  LogPacker one, two;
  OwnEvents log = pack_all(one, first);
  const OwnEvents more = pack_all(two, second);
  log.insert(log.end(), second.begin(), second.end());  // a plain one between them
  log.insert(log.end(), more.begin(), more.end());
  LogUnpacker unpacker;
  const OwnEvents back = unpack_all(unpacker, log);
  ASSERT_EQ(back.size(), first.size() + 2 * second.size());
  EXPECT_TRUE(std::equal(first.begin(), first.end(), back.begin()));
  EXPECT_TRUE(std::equal(second.begin(), second.end(), back.end() - second.size()));
}

TEST(PackedLog, AllocatesNothingOnceAChannelIsKnown) {
  const OwnEvents evening = recorded_evening(400);
  LogPacker packer;
  LogUnpacker unpacker;
  for (std::size_t i = 0; i < 5; ++i) unpacker.unpack(packer.pack(evening[i].event()));
  const AllocationGuard guard;
  for (std::size_t i = 5; i < evening.size(); ++i) unpacker.unpack(packer.pack(evening[i].event()));
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(unpacker.counters().lost(), 0u);
  EXPECT_GT(packer.counters().intra_frames, 3u);
}

}  // namespace
}  // namespace dance
