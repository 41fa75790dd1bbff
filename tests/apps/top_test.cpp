// What dance top shows, and that a flood of names cannot make it grow or garble a terminal.
#include <gtest/gtest.h>

#include "apps/top/top_table.h"
#include "core/bus/encode.h"

namespace dance {
namespace {

constexpr MonoTime kBegin = MonoTime::from_us(1'000'000);

template <class Message>
void take(TopTable& table, std::string_view channel, const Message& message, MonoTime now) {
  MessageBuffer buffer;
  const std::size_t size = encode(message, buffer);
  table.take(channel, {buffer.data(), size}, now);
}

std::string row_of(const std::string& text, const std::string& name) {
  const std::size_t begin = text.find(name);
  return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}

TEST(TopTable, TellsEachTypeByItsFingerprint) {
  const auto type_of = [](const auto& message) {
    MessageBuffer buffer;
    const std::size_t size = encode(message, buffer);
    return type_of_message({buffer.data(), size});
  };
  EXPECT_EQ(type_of(Pose()), "pose_t");
  EXPECT_EQ(type_of(Hands()), "hands_t");
  EXPECT_EQ(type_of(TimedSkeleton{average_skeleton(), {}, 0}), "skeleton_t");
  EXPECT_EQ(type_of(GuestStatus()), "guest_t");
  EXPECT_EQ(type_of(Stats()), "stats_t");
  EXPECT_EQ(type_of(StageTime()), "stage_time_t");
  EXPECT_EQ(type_of(Music()), "music_t");
  EXPECT_EQ(type_of(RoomSong()), "song_t");
  EXPECT_EQ(type_of(Chat()), "chat_t");
  EXPECT_EQ(type_of(Profile()), "profile_t");
  EXPECT_EQ(type_of(Scene()), "scene_t");
  EXPECT_EQ(type_of(Avatar()), "avatar_t");
  EXPECT_EQ(type_of(AvatarFile()), "avatar_file_t");
  EXPECT_EQ(type_of(Style()), "style_t");
  EXPECT_EQ(type_of(Placement()), "placement_t");
  EXPECT_EQ(type_of(Beat()), "beat_t");
  EXPECT_EQ(type_of(GuestStats()), "guest_stats_t");
  EXPECT_EQ(type_of(GuestTraffic()), "guest_traffic_t");
  EXPECT_EQ(type_of(FlowSetting()), "flow_t");
  EXPECT_EQ(type_of(Playout()), "playout_t");
  EXPECT_EQ(type_of(Steps()), "steps_t");
  EXPECT_EQ(type_of(Touch()), "touch_t");
  EXPECT_EQ(type_of(Haptic()), "haptic_t");
  const std::uint8_t other[16] = {1, 2, 3};
  EXPECT_EQ(type_of_message(other), "");
  EXPECT_EQ(type_of_message({other, 7}), "");
}

TEST(TopTable, RatesAreOfTheTimeSinceTheLastTable) {
  TopTable table;
  for (int i = 0; i < 60; ++i)
    take(table, "POSE/capture/alice", Pose(), kBegin + Duration::ms(i * 1000 / 60));
  const std::string first = row_of(table.text(kBegin + Duration::s(1)), "POSE/capture/alice");
  EXPECT_NE(first.find("60.0"), std::string::npos) << first;
  EXPECT_NE(first.find("pose_t"), std::string::npos);
  const std::string second = row_of(table.text(kBegin + Duration::s(3)), "POSE/capture/alice");
  EXPECT_NE(second.find(" 0.0"), std::string::npos) << second;
  EXPECT_NE(second.find("2.0 s"), std::string::npos) << second;
  EXPECT_NE(second.find(" 60"), std::string::npos) << second;
}

TEST(TopTable, ShowsWhatADisplayMeasuredAndDashesForWhatItDidNot) {
  TopTable table;
  GuestStats stats;
  stats.newest_p50_ms = 61.4f;
  stats.jitter_ms = 2.75f;
  take(table, "GUEST_STATS/view/alice", stats, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  const std::string row = row_of(text.substr(text.find("shown")), "alice");
  EXPECT_NE(row.find(" 61 "), std::string::npos) << text;
  EXPECT_NE(row.find(" 2.8 "), std::string::npos) << row;
  EXPECT_NE(row.find(" - "), std::string::npos) << row;
}

TEST(TopTable, ShowsWhichTransformersAreUsed) {
  TopTable table;
  FlowSetting setting;
  setting.has = {false, true, true, true, false};
  setting.on[index_of(FlowWord::kBridge)] = false;
  setting.lead = 0.75f;
  take(table, "FLOW/capture/bob", setting, kBegin);  // only what is in force counts
  EXPECT_EQ(table.text(kBegin).find("predict"), std::string::npos);
  take(table, "FLOW/stage/bob", setting, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  const std::string row = row_of(text.substr(text.find("predict")), "bob");
  EXPECT_NE(row.find("on  0.75"), std::string::npos) << text;
  EXPECT_NE(row.find("off"), std::string::npos) << row;
  EXPECT_NE(row.find("auto"), std::string::npos) << row;
}

TEST(TopTable, SaysOfEachGuestWhatIsShownAndWhy) {
  TopTable table;
  Playout playout;
  playout.reason = PlayoutReason::kAsked;
  playout.beats = 1.0f;
  playout.partner = *GuestId::parse("alice");
  take(table, "PLAYOUT/stage/bob", playout, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  EXPECT_NE(text.find("1 beat behind, as asked; beside alice"), std::string::npos) << text;
}

TEST(TopTable, ProgramsAreShownFromTheirStatistics) {
  TopTable table;
  Stats stats;
  stats.received = 1234;
  stats.lost = 5;
  stats.dropped_late = 2;
  stats.dropped_invalid = 1;
  stats.round_trip = Duration::ms(80);
  take(table, "STATS/link", stats, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  const std::size_t programs = text.find("program ");
  ASSERT_NE(programs, std::string::npos) << text;
  const std::string row = row_of(text.substr(programs), "link");
  EXPECT_NE(row.find("1234"), std::string::npos) << text;
  EXPECT_NE(row.find("80.0 ms"), std::string::npos) << row;
  EXPECT_NE(row.find(" 3 "), std::string::npos) << row;
}

TEST(TopTable, AGuestsStyleIsShownZoneByZone) {
  TopTable table;
  Style style;
  style.gain[0] = 1.5f;
  style.dynamic = 0.25f;
  take(table, "STYLE/guest/alice", style, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  const std::string row = text.substr(text.rfind("STYLE/guest/alice"));
  EXPECT_NE(row.find("1.50"), std::string::npos) << text;
  EXPECT_NE(row.find("0.25"), std::string::npos) << text;
  EXPECT_NE(text.find("shoulders"), std::string::npos);
  style.gain[0] = 2.0f;
  take(table, "STYLE/guest/alice", style, kBegin + Duration::s(2));
  EXPECT_EQ(table.text(kBegin + Duration::s(2)).find("1.50"), std::string::npos);
}

TEST(TopTable, TheTempoAtWhichDancersStepIsShown) {
  TopTable table;
  Steps steps;
  steps.tempo_bpm = 96.5;
  steps.weight = 0.75f;
  steps.dancers = 2;
  take(table, "STEPS/local", steps, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  const std::string row = text.substr(text.rfind("STEPS/local"));
  EXPECT_NE(row.find("96.5"), std::string::npos) << text;
  EXPECT_NE(row.find("0.75"), std::string::npos) << text;
  EXPECT_NE(row.find("here"), std::string::npos) << text;
}

TEST(TopTable, AFloodOfNamesIsBoundedAndSaid) {
  TopTable table;
  for (int i = 0; i < 100'000; ++i)
    table.take("noise-" + std::to_string(i), {}, kBegin + Duration::us(i));
  EXPECT_EQ(table.channel_count(), TopTable::kMaxChannels);
  EXPECT_EQ(table.beyond_bounds(), 100'000 - TopTable::kMaxChannels);
  EXPECT_NE(table.text(kBegin + Duration::s(1)).find("more channels than the table holds"),
            std::string::npos);
}

TEST(TopTable, ChannelsSilentForAMinuteGiveTheirPlaceAway) {
  TopTable table;
  table.take("old", {}, kBegin);
  table.text(kBegin + Duration::s(30));
  EXPECT_EQ(table.channel_count(), 1u);
  table.text(kBegin + Duration::s(61));
  EXPECT_EQ(table.channel_count(), 0u);
}

TEST(TopTable, NamesCannotCommandTheTerminal) {
  TopTable table;
  table.take("\033[2J\007\r\n\xff", {}, kBegin);
  const std::string text = table.text(kBegin + Duration::s(1));
  for (const char c : {'\033', '\007', '\r', '\xff'}) EXPECT_EQ(text.find(c), std::string::npos);
  EXPECT_NE(text.find("?[2J????"), std::string::npos) << text;
}

TEST(TopTable, ABusWithoutSpeakersSaysSo) {
  EXPECT_NE(TopTable().text(kBegin).find("nobody speaks"), std::string::npos);
}

}  // namespace
}  // namespace dance
