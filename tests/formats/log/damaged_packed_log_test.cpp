// Packed logs that lost something or were damaged: what is gone is counted, and what comes is true.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/bus/channel.h"
#include "formats/log/log_packer.h"
#include "formats/log/unpacked_log.h"
#include "tests/formats/log/recorded_dance.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

OwnEvents packed_events(const OwnEvents& events) {
  LogPacker packer;
  OwnEvents packed;
  for (const OwnEvent& event : events) packed.emplace_back(packer.pack(event.event()));
  return packed;
}

Bytes log_of(const OwnEvents& events) {
  const TestFolder folder("packed-log");
  const std::string path = folder.path("log.lcm");
  {
    auto writer = LogWriter::create(path);
    EXPECT_TRUE(writer) << writer.error().what;
    for (const OwnEvent& event : events) EXPECT_TRUE(writer->append(event.event()));
    EXPECT_TRUE(writer->flush());
  }
  return bytes_in(path);
}

OwnEvents events_of(UnpackedLog& log) {
  OwnEvents events;
  while (const auto event = log.next()) events.emplace_back(*event);
  return events;
}

TEST(DamagedPackedLog, AnUndamagedOneIsReadAgainFromItsBeginning) {
  const OwnEvents evening = recorded_evening(30);
  const Bytes bytes = log_of(packed_events(evening));
  UnpackedLog log = UnpackedLog::over(bytes);
  EXPECT_TRUE(events_of(log) == evening);
  log.rewind();
  EXPECT_TRUE(events_of(log) == evening);
  EXPECT_EQ(log.unpacking().lost() + log.skipped_bytes(), 0u);
}

TEST(DamagedPackedLog, ALostEventCostsItsChannelUntilTheNextIntraFrame) {
  const OwnEvents evening = recorded_evening(620);
  OwnEvents packed = packed_events(evening);
  // The 41st pose of alice, who begins anew with her 61st.
  std::size_t alices = 0, lost_at = 0;
  while (alices < 41) alices += evening[lost_at++].channel == "POSE/capture/alice" ? 1 : 0;
  packed.erase(packed.begin() + static_cast<std::ptrdiff_t>(lost_at) - 1);
  const Bytes bytes = log_of(packed);
  UnpackedLog log = UnpackedLog::over(bytes);
  const OwnEvents back = events_of(log);
  EXPECT_EQ(log.unpacking().orphaned, 60u - 41u);
  EXPECT_EQ(log.unpacking().damaged, 0u);
  EXPECT_EQ(back.size(), evening.size() - 20u);
  const std::set<std::int64_t> numbers = [&] {
    std::set<std::int64_t> all;
    for (const OwnEvent& event : back) {
      EXPECT_TRUE(event == evening[static_cast<std::size_t>(event.number)]);
      all.insert(event.number);
    }
    return all;
  }();
  for (const OwnEvent& event : evening) {
    if (event.channel == "POSE/capture/alice") continue;
    EXPECT_TRUE(numbers.contains(event.number));
  }
}

TEST(DamagedPackedLog, AnEventThatIsThereTwiceOrTooLateCostsOnlyItself) {
  const OwnEvents evening = recorded_evening(30);
  const OwnEvents packed = packed_events(evening);
  for (const std::size_t from : {5u, 10u, 11u, 12u, 25u}) {
    OwnEvents more = packed;
    more.insert(more.begin() + 60, packed[from]);
    LogUnpacker unpacker;
    OwnEvents back;
    for (const OwnEvent& event : more)
      if (const auto plain = unpacker.unpack(event.event())) back.emplace_back(*plain);
    EXPECT_TRUE(back == evening) << from;
    EXPECT_EQ(unpacker.counters().orphaned, 1u);
  }
}

TEST(DamagedPackedLog, EveryPrefixGivesItsWholeEvents) {
  const OwnEvents evening = recorded_evening(6);
  const OwnEvents packed = packed_events(evening);
  const Bytes bytes = log_of(packed);
  std::size_t whole = 0, end = packed[0].event().stored_bytes();
  for (std::size_t size = 0; size <= bytes.size(); size += 3) {
    while (whole < packed.size() && end <= size)
      end += ++whole < packed.size() ? packed[whole].event().stored_bytes() : 0;
    UnpackedLog log = UnpackedLog::over({bytes.data(), size});
    const OwnEvents back = events_of(log);
    ASSERT_EQ(back.size(), whole) << size;
    EXPECT_TRUE(std::equal(back.begin(), back.end(), evening.begin()));
    EXPECT_EQ(log.unpacking().lost(), 0u);
  }
}

// A flipped bit in LCM's own part of an event (its number, its time, the name of what is no pose)
// is beyond any checksum, as it is in a plain log.
TEST(DamagedPackedLog, NoFlippedBitMakesAPoseThatWasNotThere) {
  const OwnEvents evening = recorded_evening(4);
  const OwnEvents packed = packed_events(evening);
  const Bytes bytes = log_of(packed);
  std::size_t noticed = 0, flips = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 11, ++flips) {
    Bytes damaged = bytes;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << (bit % 8)));
    UnpackedLog log = UnpackedLog::over(damaged);
    std::size_t poses = 0;
    for (const OwnEvent& event : events_of(log)) {
      const auto channel = Channel::parse(event.channel);
      if (!channel || (channel->signal() != Signal::kPose && channel->signal() != Signal::kHands))
        continue;
      ++poses;
      const bool was_there = std::any_of(evening.begin(), evening.end(), [&](const OwnEvent& was) {
        return was.channel == event.channel && was.data == event.data;
      });
      ASSERT_TRUE(was_there) << "bit " << bit << " on " << event.channel;
    }
    if (poses < 16 && log.unpacking().lost() + log.skipped_bytes() > 0) ++noticed;
    if (poses == 16) ++noticed;  // nothing is missing
  }
  // Not so where the last of a channel is no longer known as packed.
  EXPECT_GE(noticed + flips / 50, flips);
}

TEST(DamagedPackedLog, OddEventsAreCountedByCause) {
  const OwnEvents packed = packed_events(recorded_evening(2));
  const auto& good = packed.front();
  const auto lost_as = [&](const std::string& channel, const Bytes& data) {
    LogUnpacker unpacker;
    EXPECT_FALSE(unpacker.unpack({0, 0, channel, data}));
    return unpacker.counters();
  };
  Bytes newer = good.data;
  newer[3] = 2;
  EXPECT_EQ(lost_as(good.channel, newer).newer, 1u);
  Bytes kind = good.data;
  kind[4] = 77;
  EXPECT_EQ(lost_as(good.channel, kind).damaged, 1u);
  EXPECT_EQ(lost_as("PACKED/", good.data).damaged, 1u);
  EXPECT_EQ(lost_as("PACKED/POSE/capture/bob", good.data).damaged, 1u);
  EXPECT_EQ(lost_as(good.channel, {'D', 'P', 'K', 1, 0, 200, 'x'}).damaged, 1u);
  EXPECT_EQ(lost_as(good.channel, {'D', 'P', 'K', 1, 0, 1, 'x', 1, 2, 3}).damaged, 1u);
  for (std::size_t size = 4; size < good.data.size(); ++size) {
    const Bytes cut(good.data.begin(), good.data.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(lost_as(good.channel, cut).damaged, 1u) << size;
  }
  EXPECT_EQ(lost_as(packed[5].channel, packed[5].data).orphaned, 1u);
}

// A file of version 1 that an earlier build wrote: its checksums say whether this one reads it to
// the bit.
TEST(DamagedPackedLog, YesterdaysPackedLogIsReadToTheBit) {
  const Bytes bytes = bytes_in(DANCE_SOURCE_DIR "/tests/formats/log/golden/version_1.lcm");
  ASSERT_GT(bytes.size(), 1000u);
  UnpackedLog log = UnpackedLog::over(bytes);
  EXPECT_TRUE(events_of(log) == recorded_evening(40));
  EXPECT_EQ(log.unpacking().unpacked, 160u);
  EXPECT_EQ(log.unpacking().lost() + log.skipped_bytes(), 0u);
}

}  // namespace
}  // namespace dance
