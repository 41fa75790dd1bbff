// Where a recording is played: pauses, jumps, loops.
#include "viewer/replay/replay_player.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

MonoTime at(double s) { return MonoTime() + Duration::seconds(100.0 + s); }

// Ten seconds of two guests at 50 Hz, at two beats a second, bars of four.
std::shared_ptr<const ReplayIndex> ten_seconds() {
  auto index = std::make_shared<ReplayIndex>();
  index->begin = at(0.0);
  index->end = at(10.0);
  index->guests.push_back({*GuestId::parse("alice"), at(0.0), at(10.0), 501});
  index->guests.push_back({*GuestId::parse("bob"), at(2.0), at(10.0), 301});
  index->gaps.push_back({1, at(4.0), at(6.0)});
  for (int beat = 0; beat <= 20; ++beat)
    index->beats.push_back({static_cast<double>(beat), at(0.5 * beat), 4});
  index->checkpoints.push_back({});
  return index;
}

TEST(ReplayPlayer, PlaysAtItsSpeedAndStandsWhilePaused) {
  ReplayPlayer player(ten_seconds());
  player.advance(Duration::s(1));
  EXPECT_EQ(player.position(), at(1.0));
  player.set_speed(0.1);
  player.advance(Duration::s(1));
  EXPECT_EQ(player.position(), at(1.1));
  player.toggle_playing();
  player.advance(Duration::s(1));
  EXPECT_EQ(player.position(), at(1.1));
}

TEST(ReplayPlayer, StepsBackTheFrameThatItSteppedOn) {
  ReplayPlayer player(ten_seconds());
  EXPECT_NEAR(player.frame_hz(), 50.0, 1e-9);
  player.go_to(at(3.0));
  player.step_frames(1);
  EXPECT_EQ(player.position(), at(3.02));
  EXPECT_FALSE(player.is_playing());
  player.step_frames(-1);
  EXPECT_EQ(player.position(), at(3.0));
}

TEST(ReplayPlayer, StaysWithinTheRecording) {
  ReplayPlayer player(ten_seconds());
  player.jump(-Duration::s(5));
  EXPECT_EQ(player.position(), at(0.0));
  player.jump(Duration::s(50));
  EXPECT_EQ(player.position(), at(10.0));
}

TEST(ReplayPlayer, JumpsToBeatsAndBars) {
  ReplayPlayer player(ten_seconds());
  player.set_playing(false);
  player.go_to(at(2.6));
  player.jump_beats(1);
  EXPECT_EQ(player.position(), at(3.0));
  player.jump_beats(-2);
  EXPECT_EQ(player.position(), at(2.0));
  player.jump_bars(1);
  EXPECT_EQ(player.position(), at(4.0));
  player.jump_bars(-2);
  EXPECT_EQ(player.position(), at(0.0));
  player.jump_bars(-1);
  EXPECT_EQ(player.position(), at(0.0));
}

TEST(ReplayPlayer, JumpsBackOverTheBeatThatHasJustBeen) {
  ReplayPlayer player(ten_seconds());
  player.go_to(at(2.55));
  player.jump_beats(-1);
  EXPECT_EQ(player.position(), at(2.0));
}

TEST(ReplayPlayer, RepeatsTheWholeOrTheLoop) {
  ReplayPlayer player(ten_seconds());
  player.go_to(at(9.9));
  player.advance(Duration::ms(200));
  EXPECT_EQ(player.position(), at(0.1));
  player.go_to(at(2.0));
  player.set_loop_begin();
  player.go_to(at(4.0));
  player.set_loop_end();
  EXPECT_TRUE(player.loops());
  player.advance(Duration::ms(500));
  EXPECT_EQ(player.position(), at(2.5));
  player.toggle_loop();
  player.go_to(at(3.9));
  player.advance(Duration::ms(200));
  EXPECT_EQ(player.position(), at(4.1));
}

TEST(ReplayPlayer, ALoopBehindItsEndGoesOnToTheEndOfTheRecording) {
  ReplayPlayer player(ten_seconds());
  player.go_to(at(2.0));
  player.set_loop_begin();
  player.go_to(at(4.0));
  player.set_loop_end();
  player.go_to(at(6.0));
  player.advance(Duration::s(1));
  EXPECT_EQ(player.position(), at(7.0));
}

TEST(ReplayPlayer, AnEndBeforeTheBeginningTakesItsPlace) {
  ReplayPlayer player(ten_seconds());
  player.go_to(at(5.0));
  player.set_loop_begin();
  player.go_to(at(3.0));
  player.set_loop_end();
  EXPECT_EQ(player.range_begin(), at(0.0));
  EXPECT_EQ(player.range_end(), at(3.0));
}

TEST(ReplayPlayer, SpeedsAreFromATenthToFour) {
  ReplayPlayer player(ten_seconds());
  for (int i = 0; i < 20; ++i) player.change_speed(1);
  EXPECT_EQ(player.speed(), ReplayPlayer::kFastest);
  for (int i = 0; i < 20; ++i) player.change_speed(-1);
  EXPECT_EQ(player.speed(), ReplayPlayer::kSlowest);
}

TEST(ReplayPlayer, ARecordingOfOneMomentPlays) {
  auto index = std::make_shared<ReplayIndex>();
  index->begin = index->end = at(0.0);
  index->checkpoints.push_back({});
  ReplayPlayer player(index);
  player.advance(Duration::s(1));
  player.set_loop_begin();
  player.advance(Duration::s(1));
  player.step_frames(-3);
  EXPECT_EQ(player.position(), at(0.0));
}

}  // namespace
}  // namespace dance
