// The table of message types: every signal of the table of channels has its row, and a type that
// only this test has needs no more than one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "tests/allocation_guard.h"
#include "tests/core/bus/tap.h"

namespace dance {
namespace {

TEST(MessageTable, HasTheTypeOfEverySignalInTheTableOfChannels) {
  std::map<Signal, std::string> of_channels;
  for (const ChannelRow& row : kChannelTable) {
    const auto [known, is_new] = of_channels.emplace(row.signal, row.type);
    EXPECT_EQ(known->second, row.type) << row.pattern;
  }
  std::map<Signal, std::string> of_rows;
  for_each_message_type([&]<class Message>() {
    of_rows.emplace(MessageTraits<Message>::kSignal, MessageTraits<Message>::type_name());
  });
  EXPECT_EQ(of_rows, of_channels);
}

TEST(MessageTable, TakesANewTypeByItsRow) {
  static_assert(BusMessage<Tap> && !BusMessage<int>);
  EXPECT_EQ(MessageTraits<Tap>::type_name(), "tap_t");
  MessageBuffer buffer;
  const std::size_t size = encode(some_tap(), buffer);
  EXPECT_EQ(size, 8u + 8 + 8 + 4 + 8 + 8);
  Tap out;
  ASSERT_EQ(decode(buffer.data(), size, out), Decoded::kFine);
  EXPECT_EQ(out.time, some_tap().time);
  EXPECT_EQ(out.clock_id, 77u);
  EXPECT_EQ(out.count, 3u);
  EXPECT_EQ(out.force_n, 12.5);
  EXPECT_EQ(out.foot, some_tap().foot);
}

TEST(MessageTable, ChecksANewTypeAsAnyOther) {
  MessageBuffer buffer;
  const std::size_t size = encode(some_tap(), buffer);
  Tap out = some_tap(9);
  for (std::size_t cut = 0; cut < size; ++cut)
    EXPECT_EQ(decode(buffer.data(), cut, out), Decoded::kUndecodable) << cut;
  EXPECT_EQ(decode(buffer.data(), size + 1, out), Decoded::kUndecodable);
  const auto outcome_of = [&](auto change) {
    Tap tap = some_tap();
    change(tap);
    return decode(buffer.data(), encode(tap, buffer), out);
  };
  EXPECT_EQ(outcome_of([](Tap& tap) { tap.force_n = 1001.0; }), Decoded::kInvalid);
  EXPECT_EQ(outcome_of([](Tap& tap) { tap.force_n = std::nan(""); }), Decoded::kInvalid);
  const MonoTime end_of_time = MonoTime::from_ns(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(outcome_of([&](Tap& tap) { tap.time = end_of_time; }), Decoded::kInvalid);
  EXPECT_EQ(encode(some_tap(), buffer), size);
  buffer[size - 1] = 'x';  // behind the end of the name
  EXPECT_EQ(decode(buffer.data(), size, out), Decoded::kInvalid);
  EXPECT_EQ(out.count, 9u) << "what is refused changes nothing";
  const AllocationGuard guard;
  EXPECT_EQ(outcome_of([](Tap&) {}), Decoded::kFine);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
