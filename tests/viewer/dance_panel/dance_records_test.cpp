// Who is in the panel's list of guests, and how well each comes over.
#include "viewer/dance_panel/dance_records.h"

#include <gtest/gtest.h>

#include "tests/viewer/instruments/synthetic_line.h"

namespace dance {
namespace {

struct Room {
  void status(const char* name, bool is_remote, bool is_alive, std::int64_t received) {
    GuestStatus status;
    status.remote = is_remote;
    status.alive = is_alive;
    status.received = received;
    board.on_status(guest_called(name), status, now);
  }
  void look() {
    records.take(board, now);
    records.judge(figures, scene, now);
  }
  std::string names() const {
    std::string all;
    for (const DanceGuest& guest : records.guests()) all += std::string(guest.id.view()) + " ";
    return all;
  }

  DanceBoard board;
  DanceRecords records;
  InstrumentBoard instruments{kHouseClock};
  InstrumentRecords figures;
  SceneState scene;
  MonoTime now = at_ms(100'000.0);
};

TEST(DanceRecords, ASilentGuestStaysWhileTheLinkNamesItAndThenGoes) {
  Room room;
  for (int second = 0; second < 5; ++second, room.now += Duration::s(1)) {
    room.status("bob", true, true, 60 * second);
    room.status("alice", false, true, 60 * second);
    room.board.on_traffic(guest_called("bob"), room.now);
    room.look();
  }
  EXPECT_EQ(room.names(), "alice bob ");
  EXPECT_EQ(room.records.find(guest_called("bob"))->quality.shown().level, QualityLevel::kGood);
  // Its house sends nothing: the manager says so once, the link goes on naming it.
  room.status("bob", true, false, 240);
  for (int second = 0; second < 6; ++second, room.now += Duration::s(1)) {
    room.status("alice", false, true, 300 + 60 * second);
    room.board.on_traffic(guest_called("bob"), room.now);
    room.look();
  }
  const DanceGuest* bob = room.records.find(guest_called("bob"));
  ASSERT_NE(bob, nullptr);
  EXPECT_EQ(bob->quality.shown().level, QualityLevel::kBad);
  EXPECT_EQ(bob->quality.shown().reason, QualityReason::kSilent);
  // It has left.
  room.now += Duration::s(5);
  room.look();
  EXPECT_EQ(room.names(), "alice ") << "a camera of this house may come back";
}

TEST(DanceRecords, AHiddenGuestIsNotJudgedNorAtOnceWhenShownAgain) {
  Room room;
  const auto second = [&](std::int64_t received) {
    room.status("bob", true, true, received);
    room.board.on_traffic(guest_called("bob"), room.now);
    room.look();
    room.now += Duration::s(1);
    return room.records.find(guest_called("bob"))->quality.shown().level;
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(second(60 * i), QualityLevel::kGood);
  room.records.choice_of(guest_called("bob")).is_hidden = true;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(second(240), QualityLevel::kGood) << "none are wanted";
  room.records.choice_of(guest_called("bob")).is_hidden = false;
  EXPECT_EQ(second(240), QualityLevel::kGood);
  for (int i = 0; i < 5; ++i) second(240);
  EXPECT_EQ(second(240), QualityLevel::kBad) << "they are wanted and do not come";
}

TEST(DanceRecords, ADancerOfThisHouseWhoIsHiddenIsMissedWhenNoPoseComes) {
  Room room;
  room.records.choice_of(guest_called("alice")).is_hidden = true;
  const MonoTime begin = room.now;
  for (int second = 0; second < 6; ++second, room.now += Duration::s(1)) {
    room.status("alice", false, true, 60);
    room.look();
  }
  EXPECT_EQ(room.records.find(guest_called("alice"))->moved, begin) << "the camera has stopped";
}

TEST(DanceRecords, LossIsTheMeanOfSomeSeconds) {
  Room room;
  std::uint32_t sequence = 0;
  for (int second = 0; second < 12; ++second) {
    const bool is_burst = second == 6;
    for (int i = 0; i < 60; ++i, ++sequence) {
      const MonoTime captured = room.now + Duration::ms(16) * i;
      if (is_burst && i >= 10 && i < 40) continue;
      const Pose pose = arrived_at_house(captured, sequence);
      room.instruments.on_pose(Where::kGuest, guest_called("bob"), pose,
                               captured + Duration::ms(52));
    }
    room.now += Duration::ms(960);
    room.instruments.end_seconds(room.now, [](const GuestId&, const GuestStats&) {});
    room.figures.take(room.instruments);
    room.status("bob", true, true, sequence);
    room.board.on_traffic(guest_called("bob"), room.now);
    room.look();
  }
  const QualityVerdict& verdict = room.records.find(guest_called("bob"))->quality.shown();
  EXPECT_EQ(verdict.reason, QualityReason::kLoses);
  EXPECT_GT(verdict.value, 4.0f) << "half a second of five";
}

// Six seconds of a guest whose poses this machine shows 400 ms after they arrived.
void draw_slowly(Room& room, const char* name, bool is_remote, double more_network_ms = 0.0) {
  const Duration drawing = Duration::ms(400);
  std::uint32_t sequence = 0;
  for (int second = 0; second < 6; ++second) {
    for (int i = 0; i < 60; ++i, ++sequence) {
      const MonoTime captured = room.now + Duration::ms(16) * i;
      const Pose pose = is_remote ? arrived_at_house(captured, sequence, more_network_ms)
                                  : dance_at(captured, sequence);
      const double path_ms = kPublished_ms + kSent_ms + kServer_ms + kReceived_ms + 1.0;
      const MonoTime heard =
          captured + Duration::seconds(is_remote ? 1e-3 * (path_ms + more_network_ms) : 1e-3);
      room.instruments.on_pose(is_remote ? Where::kGuest : Where::kCapture, guest_called(name),
                               pose, heard);
      room.instruments.on_shown(guest_called(name), shown_at(pose, heard, heard + drawing));
    }
    room.now += Duration::ms(960);
    room.instruments.end_seconds(room.now, [](const GuestId&, const GuestStats&) {});
    room.figures.take(room.instruments);
    room.status(name, is_remote, true, sequence);
    if (is_remote) room.board.on_traffic(guest_called(name), room.now);
    room.look();
  }
}

TEST(DanceRecords, SlowDrawingDoesNotCountAsDelay) {
  Room room;
  draw_slowly(room, "bob", true);
  EXPECT_EQ(room.records.find(guest_called("bob"))->quality.shown().level, QualityLevel::kGood);
}

TEST(DanceRecords, DelayIsThatOfNetworkAndServerOnly) {
  Room room;
  draw_slowly(room, "bob", true, 200.0);
  const QualityVerdict& verdict = room.records.find(guest_called("bob"))->quality.shown();
  EXPECT_EQ(verdict.reason, QualityReason::kLate);
  EXPECT_NEAR(verdict.value, kServer_ms + kReceived_ms + 200.0, 2.0);
}

TEST(DanceRecords, DancersOfThisHouseHaveNoNetworkDelay) {
  Room room;
  draw_slowly(room, "alice", false);
  EXPECT_EQ(room.records.find(guest_called("alice"))->quality.shown().level, QualityLevel::kGood);
}

TEST(DanceRecords, ChoicesOutliveAGuestAndTheListIsBounded) {
  Room room;
  room.records.choice_of(guest_called("bob")).volume = 0.5f;
  room.status("bob", true, true, 1);
  room.look();
  room.now += Duration::s(30);
  room.look();
  EXPECT_EQ(room.names(), "");
  EXPECT_EQ(room.records.choice_of(guest_called("bob")).heard_volume(), 0.5f);
  for (int i = 0; i < 200; ++i) {
    room.status(("g" + std::to_string(i)).c_str(), true, true, 1);
    room.look();
  }
  EXPECT_EQ(room.records.guests().size(), DanceRecords::kMost);
}

TEST(DanceRecords, AVoicesLevelHoldsForAMoment) {
  Room room;
  room.board.on_level(guest_called("alice"), {room.now, 1, -20, -30}, room.now);
  room.look();
  ASSERT_TRUE(room.records.level_of(guest_called("alice"), room.now));
  EXPECT_EQ(room.records.level_of(guest_called("alice"), room.now)->level_dbfs, -20);
  EXPECT_FALSE(room.records.level_of(guest_called("alice"), room.now + Duration::s(1)));
  EXPECT_FALSE(room.records.level_of(guest_called("bob"), room.now));
}

}  // namespace
}  // namespace dance
