// All guests of a house: bounds, who is told of, and what passes between the two threads.
#include "viewer/instruments/instrument_board.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/allocation_guard.h"
#include "tests/viewer/instruments/synthetic_line.h"
#include "viewer/instruments/instrument_records.h"

namespace dance {
namespace {

GuestId numbered(int i) { return guest_called("guest-" + std::to_string(100 + i)); }

// `seconds` of `guests` dancers of 60 poses a second, each on the stage as it comes.
void play(InstrumentBoard& board, int guests, double from_s, double seconds,
          std::map<std::string, int>* told = nullptr) {
  const auto say = [&](const GuestId& guest, const GuestStats&) {
    if (told != nullptr) ++(*told)[std::string(guest.view())];
  };
  for (int i = 0; i < static_cast<int>(60.0 * seconds); ++i) {
    const MonoTime captured = at_ms(1e3 * from_s + i * (1000.0 / 60.0));
    const MonoTime now = captured + Duration::ms(60);
    for (int g = 0; g < guests; ++g) {
      const auto sequence = static_cast<std::uint32_t>(60.0 * from_s + i);
      const Pose pose = arrived_at_house(captured, sequence);
      board.on_pose(Where::kGuest, numbered(g), pose, now);
      board.on_pose(Where::kStage, numbered(g), pose, now);
    }
    board.end_seconds(now, say);
  }
}

TEST(InstrumentBoard, TellsOfEachGuestOnceASecond) {
  InstrumentBoard board(kHouseClock);
  std::map<std::string, int> told;
  play(board, 30, 10.0, 5.5, &told);
  ASSERT_EQ(told.size(), 30u);
  for (const auto& [guest, times] : told) EXPECT_EQ(times, 5) << guest;
}

TEST(InstrumentBoard, DoesNotTellOfTwinsNorOfThoseWhoAreGone) {
  InstrumentBoard board(kHouseClock);
  std::vector<std::string> told;
  const auto say = [&](const GuestId& guest, const GuestStats&) {
    told.emplace_back(guest.view());
  };
  board.on_pose(Where::kStage, guest_called("bob"), dance_at(at_ms(5000), 0), at_ms(5000));
  board.on_pose(Where::kStage, guest_called("bob-raw"), dance_at(at_ms(5000), 0), at_ms(5000));
  board.end_seconds(at_ms(6500), say);
  EXPECT_EQ(told, std::vector<std::string>{"bob"});
  board.end_seconds(at_ms(9500), say);
  EXPECT_EQ(told.size(), 1u) << "silent for more than three seconds";
}

TEST(InstrumentBoard, KeepsItsBoundsAndGivesThePlaceOfTheSilentAway) {
  InstrumentBoard board(kHouseClock);
  std::map<std::string, int> told;
  play(board, static_cast<int>(InstrumentsMeter::kMaxGuests) + 16, 10.0, 2.0, &told);
  EXPECT_EQ(told.size(), InstrumentsMeter::kMaxGuests);
  told.clear();
  const auto say = [&](const GuestId& guest, const GuestStats&) {
    ++told[std::string(guest.view())];
  };
  for (int i = 0; i < 100; ++i) {
    const MonoTime now = at_ms(30'000.0 + 20.0 * i);
    board.on_pose(Where::kStage, guest_called("newcomer"), dance_at(now, 1), now);
    board.end_seconds(now, say);
  }
  EXPECT_EQ(told.size(), 1u);
  EXPECT_EQ(told.count("newcomer"), 1u);
}

TEST(InstrumentBoard, AllocatesNothingOnTheBusThread) {
  InstrumentBoard board(kHouseClock);
  const Channel channel = Channel::of(Signal::kPose, Where::kStage, guest_called("bob"));
  MessageBuffer buffer;
  play(board, 3, 10.0, 0.1);
  const AllocationGuard guard;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const MonoTime now = at_ms(20'000.0 + 10.0 * i);
    const Pose pose = dance_at(now, i);
    const std::size_t size = encode(pose, buffer);
    board.on_message(channel, buffer.data(), size, now);
    board.end_seconds(now, [](const GuestId&, const GuestStats&) {});
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(InstrumentBoard, MeasuresARecordingThatIsSoughtIn) {
  InstrumentBoard board(kHouseClock);
  InstrumentRecords records;
  play(board, 2, 100.0, 3.2);
  records.take(board);
  ASSERT_EQ(records.guests().size(), 2u);
  EXPECT_EQ(records.guests()[0].size(), 3u);
  play(board, 2, 20.0, 2.2);
  records.take(board);
  ASSERT_EQ(records.guests().size(), 2u);
  EXPECT_LT(records.guests()[0].newest().time, at_ms(23'000.0));
  EXPECT_EQ(records.guests()[0].size(), 2u) << "the minute begins anew";
}

TEST(InstrumentRecords, KeepAMinuteAndForgetWhoIsGone) {
  InstrumentBoard board(kHouseClock);
  InstrumentRecords records;
  for (int s = 0; s < 80; ++s) {
    play(board, s < 70 ? 2 : 1, 100.0 + s, 1.0);
    records.take(board);
  }
  ASSERT_EQ(records.guests().size(), 1u);
  EXPECT_EQ(records.guests()[0].size(), GuestRecord::kSeconds);
  EXPECT_LT(records.guests()[0].at(0).time, records.guests()[0].at(59).time);
  EXPECT_EQ(records.find(guest_called("guest-101")), nullptr);
}

TEST(InstrumentBoard, PassesWhatIsAskedForToTheBusThread) {
  InstrumentBoard board(kHouseClock);
  FlowSetting setting;
  setting.lead = 0.25f;
  board.ask(guest_called("bob"), setting);
  board.ask(guest_called("alice"), Style());
  const auto flow = board.take_asked_flow();
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->guest, guest_called("bob"));
  EXPECT_EQ(flow->what.lead, 0.25f);
  Playout playout;
  playout.reason = PlayoutReason::kAsked;
  board.on_playout(guest_called("bob"), playout);
  const auto told = board.take_playout();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->what.reason, PlayoutReason::kAsked);
  EXPECT_FALSE(board.take_asked_flow());
  ASSERT_TRUE(board.take_asked_style());
}

}  // namespace
}  // namespace dance
