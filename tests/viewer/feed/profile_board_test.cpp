// Tests the way of shown names, and of the signs of other houses (recording, host), to the picture.
#include <gtest/gtest.h>

#include "core/bus/encode.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/replay/board_feed.h"

namespace dance {
namespace {

const MonoTime kFirst = MonoTime::from_us(1'000'000);

GuestId guest(const char* name) { return *GuestId::parse(name); }

Profile named(const char* name) {
  Profile profile;
  profile.shown_name = *parse_shown_name(name);
  return profile;
}

class ProfileBoardTest : public ::testing::Test {
 protected:
  void dance(const char* name, MonoTime now) {
    board.on_pose(Where::kStage, guest(name), Pose(), now);
  }
  SceneState scene_at(MonoTime now) {
    SceneState scene;
    roster.update(now, scene);
    return scene;
  }

  GuestBoard board{7, false};
  StageRoster roster{board};
};

TEST_F(ProfileBoardTest, KeepsNamesOfGuestsWithAndWithoutPoses) {
  dance("bob", kFirst);
  board.on_profile(Where::kGuest, guest("bob"), named("Bob"), kFirst);
  board.on_profile(Where::kCapture, guest("carla"), named("Carla"), kFirst);
  EXPECT_EQ(scene_at(kFirst).names.find(guest("bob")), "Bob");
  EXPECT_EQ(scene_at(kFirst).names.find(guest("carla")), "Carla");
  board.on_profile(Where::kGuest, guest("bob"), named("Robert"), kFirst);
  EXPECT_EQ(scene_at(kFirst + Duration::s(60)).names.find(guest("bob")), "Robert");
}

TEST_F(ProfileBoardTest, AddsTheIdToANameThatLooksLikeAnotherGuest) {
  board.on_profile(Where::kGuest, guest("mallory"), named("Bob"), kFirst);
  EXPECT_EQ(scene_at(kFirst).names.find(guest("mallory")), "Bob");
  dance("bob", kFirst);
  EXPECT_EQ(scene_at(kFirst).names.find(guest("mallory")), "Bob (mallory)");
}

TEST_F(ProfileBoardTest, ShowsWhichOtherHousesRecordWhileTheirLinksRepeatIt) {
  dance("bob", kFirst);
  Profile records = named("Bob");
  records.is_recording = true;
  board.on_profile(Where::kGuest, guest("bob"), records, kFirst);
  board.on_profile(Where::kCapture, guest("alice"), records, kFirst);
  SceneState scene = scene_at(kFirst + Duration::s(1));
  EXPECT_EQ(scene.recorders, std::vector<GuestId>{guest("bob")}) << "only other houses are listed";
  EXPECT_TRUE(scene.guests.at(0).is_recording);
  scene = scene_at(kFirst + ProfileBoard::kSignsHold + Duration::ms(1));
  EXPECT_TRUE(scene.recorders.empty());
}

TEST_F(ProfileBoardTest, NamesTheHostOnlyIfThereIsExactlyOne) {
  Profile host;
  host.is_host = true;
  board.on_profile(Where::kCapture, guest("alice"), host, kFirst);
  EXPECT_FALSE(scene_at(kFirst).host.is_set()) << "this house itself";
  board.on_profile(Where::kGuest, guest("bob"), host, kFirst);
  EXPECT_EQ(scene_at(kFirst).host, guest("bob"));
  board.on_profile(Where::kGuest, guest("carla"), host, kFirst);
  EXPECT_FALSE(scene_at(kFirst).host.is_set());
}

TEST_F(ProfileBoardTest, AReplayShowsNamesWithoutSigns) {
  BoardFeed feed(board, 0);
  Profile records = named("Bob");
  records.is_recording = records.is_host = true;
  MessageBuffer message;
  const std::size_t size = encode(records, message);
  const Channel channel = Channel::of(Signal::kProfile, Where::kGuest, guest("bob"));
  ASSERT_TRUE(is_shown(channel));
  feed.on_message(channel, {message.data(), size}, kFirst.since_zero_us(), false);
  const SceneState scene = scene_at(kFirst);
  EXPECT_EQ(scene.names.find(guest("bob")), "Bob");
  EXPECT_TRUE(scene.recorders.empty());
  EXPECT_FALSE(scene.host.is_set());
}

TEST_F(ProfileBoardTest, KeepsAsManyAsARoomHas) {
  for (int i = 0; i < 200; ++i)
    board.on_profile(Where::kGuest, guest(("g" + std::to_string(i)).c_str()),
                     named(("Guest " + std::to_string(i)).c_str()), kFirst + Duration::ms(i));
  const SceneState scene = scene_at(kFirst + Duration::s(1));
  EXPECT_EQ(scene.names.find(guest("g199")), "Guest 199");
  EXPECT_EQ(scene.names.find(guest("g0")), "");
}

}  // namespace
}  // namespace dance
