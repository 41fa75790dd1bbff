// Tests the way of chat from the bus to the picture.
#include <gtest/gtest.h>

#include "viewer/feed/stage_roster.h"
#include "viewer/replay/state_bytes.h"

namespace dance {
namespace {

constexpr std::uint64_t kOurClock = 42;
const MonoTime kStart = MonoTime::from_us(100'000'000);

GuestId guest(const std::string& name) { return *GuestId::parse(name); }

Chat line_of(std::string_view text, MonoTime time, std::uint64_t clock_id = kOurClock) {
  Chat chat{time, clock_id, ChatKind::kLine, {}};
  EXPECT_TRUE(chat.text.assign(text));
  return chat;
}

SceneState scene_of(StageRoster& roster, MonoTime now) {
  SceneState scene;
  roster.update(now, scene);
  return scene;
}

TEST(ChatBoard, ShowsTheNewestLinesInTheOrderOfTime) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_chat(guest("bob"), line_of("second", kStart), kStart);
  board.on_chat(guest("alice"), line_of("first", kStart - Duration::s(2)), kStart);
  board.on_chat(guest("carla"), line_of("of another clock", kStart - Duration::s(50), 7),
                kStart + Duration::s(1));
  board.on_chat(guest("dora"), line_of("of tomorrow", kStart + Duration::s(86400)),
                kStart + Duration::s(2));
  for (int picture = 0; picture < 2; ++picture) {
    const SceneState scene = scene_of(roster, kStart + Duration::s(2));
    ASSERT_EQ(scene.lines.size(), 4u);
    EXPECT_EQ(scene.lines[0].text, "first");
    EXPECT_EQ(scene.lines[0].guest, guest("alice"));
    EXPECT_EQ(scene.lines[0].written, kStart - Duration::s(2));
    EXPECT_EQ(scene.lines[1].text, "second");
    EXPECT_EQ(scene.lines[2].written, kStart + Duration::s(1)) << "when it arrived";
    EXPECT_EQ(scene.lines[3].written, kStart + Duration::s(2));
  }
  for (int i = 0; i < 50; ++i)
    board.on_chat(guest("bob"), line_of(std::to_string(i), kStart + Duration::s(10 + i)),
                  kStart + Duration::s(10 + i));
  const SceneState full = scene_of(roster, kStart + Duration::s(60));
  ASSERT_EQ(full.lines.size(), ChatBoard::kMostLines);
  EXPECT_EQ(full.lines.front().text, "30");
  board.clear(kOurClock);
  EXPECT_TRUE(scene_of(roster, kStart + Duration::s(60)).lines.empty());
}

TEST(ChatBoard, ShowsASignForTwoSeconds) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_pose(Where::kStage, guest("alice"), Pose(), kStart);
  board.on_chat(guest("alice"), {kStart, kOurClock, ChatKind::kHeart, {}}, kStart);
  const SceneState shown = scene_of(roster, kStart + Duration::ms(500));
  ASSERT_EQ(shown.guests.size(), 1u);
  EXPECT_EQ(shown.guests[0].sign, DanceSign::kHeart);
  EXPECT_FLOAT_EQ(shown.guests[0].sign_age_s, 0.5f);
  EXPECT_EQ(scene_of(roster, kStart + Duration::ms(2100)).guests.at(0).sign, DanceSign::kNone);
  // A sign that arrives after its two seconds is not shown.
  const MonoTime later = kStart + Duration::ms(2500);
  board.on_chat(guest("alice"), {kStart, kOurClock, ChatKind::kApplause, {}}, later);
  EXPECT_EQ(scene_of(roster, later).guests.at(0).sign, DanceSign::kNone);
  board.on_chat(guest("alice"), {later, kOurClock, ChatKind::kApplause, {}}, later);
  EXPECT_EQ(scene_of(roster, later).guests.at(0).sign, DanceSign::kApplause);
  EXPECT_TRUE(shown.lines.empty());
}

TEST(ChatBoard, IsKeptInTheStateOfARecording) {
  GuestBoard board(kOurClock, false), other(kOurClock, false);
  board.on_chat(guest("alice"), line_of("hola", kStart), kStart);
  board.on_chat(guest("bob"), line_of("\xc2\xa1hola!", kStart), kStart);
  const auto none = [](const GuestId&, bool) { return false; };
  ReplayStateWriter writer;
  board.carry(writer, none);
  StateReader reader(writer.bytes());
  other.carry(reader, none);
  ASSERT_TRUE(reader.is_fine());
  StageRoster roster(other);
  const SceneState scene = scene_of(roster, kStart);
  ASSERT_EQ(scene.lines.size(), 2u);
  EXPECT_EQ(scene.lines[1].text, "\xc2\xa1hola!");
  // A state with a damaged letter is refused.
  auto damaged = writer.bytes();
  constexpr std::string_view kText = "hola";
  const auto at = std::search(damaged.begin(), damaged.end(), kText.begin(), kText.end());
  ASSERT_NE(at, damaged.end());
  *at = 0x1b;
  GuestBoard third(kOurClock, false);
  StateReader bad(damaged);
  third.carry(bad, none);
  EXPECT_FALSE(bad.is_fine());
}

}  // namespace
}  // namespace dance
