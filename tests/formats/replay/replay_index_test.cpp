// An index comes back as it was written; one that is damaged, cut or extreme is refused by name.
#include "formats/replay/replay_index.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/formats/replay/some_index.h"

namespace dance {
namespace {

using test::minute_and;
using test::seal_index;
using test::some_index;

std::string why_not(const ReplayIndex& index) {
  const auto read = read_index(write_index(index));
  return read ? "it was read" : read.error().what;
}
std::string why_not(const std::function<void(ReplayIndex&)>& change) {
  ReplayIndex index = some_index();
  change(index);
  return why_not(index);
}

// Where the count of guests is: behind the head.
constexpr std::size_t kGuestCount_at = 8 + 4 + 24 + 1 + 16 + 16 + 8;

void overwrite_u32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t v) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(v >> (8 * i));
}

TEST(ReplayIndex, ComesBackAsItWasWritten) {
  const ReplayIndex index = some_index();
  const auto bytes = write_index(index);
  const auto read = read_index(bytes);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->log, index.log);
  EXPECT_EQ(read->wall_ahead_us, index.wall_ahead_us);
  EXPECT_EQ(read->begin, index.begin);
  EXPECT_EQ(read->end, index.end);
  ASSERT_EQ(read->guests.size(), 2u);
  EXPECT_EQ(read->guests[1].id.view(), "bob");
  EXPECT_EQ(read->guests[1].poses, 900u);
  ASSERT_EQ(read->gaps.size(), 1u);
  EXPECT_EQ(read->gaps[0].end, minute_and(8.0));
  EXPECT_EQ(read->gaps_left_out, 2u);
  ASSERT_EQ(read->beats.size(), 8u);
  EXPECT_EQ(read->beats[7].beat, 7.0);
  EXPECT_EQ(read->density, index.density);
  ASSERT_EQ(read->checkpoints.size(), 3u);
  EXPECT_EQ(read->checkpoints[1].state, index.checkpoints[1].state);
  EXPECT_EQ(write_index(*read), bytes);
}

TEST(ReplayIndex, HasTheChecksumThatIsDocumented) {
  const auto bytes = write_index(some_index());
  auto again = bytes;
  for (std::size_t i = again.size() - 8; i < again.size(); ++i) again[i] = 0;
  seal_index(again);
  EXPECT_EQ(again, bytes);
}

TEST(ReplayIndex, EachPrefixIsRefused) {
  const auto bytes = write_index(some_index());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto plain = read_index(std::span(bytes).first(size));
    EXPECT_FALSE(plain) << size;
    // And where somebody has made its checksum fit.
    std::vector<std::uint8_t> sealed(bytes.begin(),
                                     bytes.begin() + static_cast<std::ptrdiff_t>(size));
    sealed.resize(size + test::kIndexChecksum_bytes);
    if (size + test::kIndexChecksum_bytes == bytes.size()) continue;  // the whole
    seal_index(sealed);
    const auto read = read_index(sealed);
    ASSERT_FALSE(read) << size;
    EXPECT_FALSE(read.error().what.empty());
  }
}

TEST(ReplayIndex, EachFlippedBitIsFound) {
  const auto bytes = write_index(some_index());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    EXPECT_FALSE(read_index(flipped)) << bit;
  }
}

TEST(ReplayIndex, AFlippedBitWithAFittingChecksumIsRefusedOrSound) {
  const auto bytes = write_index(some_index());
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * (bytes.size() - test::kIndexChecksum_bytes); ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    seal_index(flipped);
    const auto read = read_index(flipped);
    if (!read) {
      ++refused;
      continue;
    }
    EXPECT_GE(read->end, read->begin);
    EXPECT_EQ(write_index(*read), flipped) << bit;
    // Any moment has a checkpoint.
    for (const double s : {-1e6, 0.0, 10.0, 1e6})
      EXPECT_LE(read->checkpoint_for(minute_and(s)).from_bytes, read->log.bytes);
  }
  EXPECT_GT(refused, bytes.size());
}

TEST(ReplayIndex, ExtremeCountsAreRefusedBeforeAnythingIsAllocated) {
  for (const std::uint32_t count :
       {3u, 255u, 256u, 257u, 1u << 20, 1u << 31, std::numeric_limits<std::uint32_t>::max()}) {
    auto bytes = write_index(some_index());
    overwrite_u32(bytes, kGuestCount_at, count);
    seal_index(bytes);
    EXPECT_FALSE(read_index(bytes)) << count;
  }
  // An index of nobody: each count behind the head in turn.
  ReplayIndex empty;
  empty.checkpoints.push_back({});
  const auto bytes = write_index(empty);
  ASSERT_TRUE(read_index(bytes));
  for (std::size_t list = 0; list < 5; ++list) {
    auto extreme = bytes;
    overwrite_u32(extreme, kGuestCount_at + 4 * list, std::numeric_limits<std::uint32_t>::max());
    seal_index(extreme);
    const auto read = read_index(extreme);
    ASSERT_FALSE(read) << list;
    EXPECT_NE(read.error().what.find("too many"), std::string::npos) << read.error().what;
  }
}

TEST(ReplayIndex, WhatCannotBeIsRefusedByName) {
  using Index = ReplayIndex;
  EXPECT_EQ(why_not([](Index& i) { i.end = i.begin - Duration::ns(1); }),
            "it ends before it begins");
  EXPECT_EQ(why_not([](Index& i) { i.begin = MonoTime::from_ns(-(std::int64_t{1} << 62)); }),
            "a time is out of bounds");
  EXPECT_EQ(why_not([](Index& i) { i.wall_ahead_us = std::numeric_limits<std::int64_t>::min(); }),
            "a time is out of bounds");
  EXPECT_EQ(why_not([](Index& i) { i.guests[0].last = minute_and(-5.0); }),
            "a guest leaves before it comes");
  EXPECT_EQ(why_not([](Index& i) { i.gaps[0].guest = 2; }),
            "a gap is of nobody, or ends before it begins");
  EXPECT_EQ(why_not([](Index& i) { i.gaps[0].end = minute_and(6.0); }),
            "a gap is of nobody, or ends before it begins");
  for (const double beat :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e10})
    EXPECT_EQ(why_not([&](Index& i) { i.beats[3].beat = beat; }), "a beat is out of bounds");
  EXPECT_EQ(why_not([](Index& i) { i.beats[0].beats_per_bar = 17; }), "a beat is out of bounds");
  EXPECT_EQ(why_not([](Index& i) { i.checkpoints[2].at_bytes = i.log.bytes + 1; }),
            "a checkpoint is not in the log");
  EXPECT_EQ(why_not([](Index& i) { i.checkpoints[1].from_bytes = 50'001; }),
            "a checkpoint is not in the log");
  EXPECT_EQ(why_not([](Index& i) { std::swap(i.checkpoints[1], i.checkpoints[2]); }),
            "a checkpoint is not in the log");
  EXPECT_EQ(why_not([](Index& i) { i.checkpoints[2].reached_us = 0; }),
            "a checkpoint is not in the log");
  EXPECT_EQ(why_not([](Index& i) { i.checkpoints.clear(); }), "it has no beginning");
  EXPECT_EQ(why_not([](Index& i) { i.checkpoints.erase(i.checkpoints.begin()); }),
            "it has no beginning");
  EXPECT_EQ(why_not([](Index& i) { i.checkpoints[1].state.resize((1 << 20) + 1); }),
            "a state is too long");
}

TEST(ReplayIndex, AnotherVersionOrAnotherFileIsRefused) {
  auto bytes = write_index(some_index());
  ++bytes[8];
  seal_index(bytes);
  EXPECT_EQ(read_index(bytes).error().what, "it is of another version");
  bytes[0] = 'd';
  EXPECT_EQ(read_index(bytes).error().what, "it is no index of a log");
  auto longer = write_index(some_index());
  longer.insert(longer.end() - 8, 0);
  seal_index(longer);
  EXPECT_EQ(read_index(longer).error().what, "something follows its end");
}

TEST(ReplayIndex, ACheckpointLiesALeadInBeforeItsMoment) {
  const ReplayIndex index = some_index();
  // Its second checkpoint has reached the tenth second, its third the 19th.
  EXPECT_EQ(index.checkpoint_for(minute_and(14.9)).at_bytes, 0u);
  EXPECT_EQ(index.checkpoint_for(minute_and(15.1)).at_bytes, 50'000u);
  EXPECT_EQ(index.checkpoint_for(minute_and(23.9)).at_bytes, 50'000u);
  EXPECT_EQ(index.checkpoint_for(minute_and(24.1)).at_bytes, 90'000u);
}

TEST(ReplayIndex, KnowsTheTimeOfABeatOrThatThereIsNone) {
  const ReplayIndex index = some_index();
  EXPECT_EQ(index.time_of_beat(3.0), minute_and(1.5));
  EXPECT_EQ(index.time_of_beat(3.5), minute_and(1.75));
  EXPECT_EQ(index.time_of_beat(8.0), std::nullopt);
  EXPECT_EQ(index.time_of_beat(-1.0), std::nullopt);
}

}  // namespace
}  // namespace dance
