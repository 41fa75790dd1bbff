// As golden_test.cpp, for states, which change rarely: the room's music and scene, a guest's
// avatar, style and place; and for the beat.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/allocation_guard.h"
#include "tests/core/bus/golden_files.h"

namespace dance {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class T>
T stamped() {
  T value;
  value.time = kCaptured;
  value.clock_id = kClock;
  return value;
}

Music golden_music() {
  auto music = stamped<Music>();
  music.start_time = MonoTime::from_us(1'234'567'000'000);
  music.start_beats = -2.5;
  music.tempo_bpm = 184.25;
  music.beats_per_bar = 4;
  music.playing = true;
  EXPECT_TRUE(music.title.assign("Fr\xc3\xbchling in Havanna"));
  return music;
}

Profile golden_profile() {
  auto profile = stamped<Profile>();
  profile.shown_name = *parse_shown_name("Zo\u00eb d\u2019\u00c5ngstr\u00f6m \u821e");
  profile.is_recording = true;
  profile.is_host = true;
  return profile;
}

RoomSong golden_song() {
  auto song = stamped<RoomSong>();
  song.start_time = MonoTime::from_us(1'234'567'000'000);
  song.start_beat = 1032;
  song.seed = 0x89abcdef;
  song.style = 5;
  song.playing = true;
  song.locked = true;
  song.tempo_count = 3;
  song.tempo_bar = {0, 8, 24};
  song.tempo_centi_bpm = {13250, 9000, 14001};
  return song;
}

Scene golden_scene() {
  auto scene = stamped<Scene>();
  scene.name = *SceneName::parse("old-mill");
  scene.floor_width_m = 12.5f;
  scene.floor_depth_m = 9.25f;
  scene.light_rgb = {1.0f, 0.5f, 0.25f};
  scene.brightness = 0.75f;
  scene.pulse = 0.125f;
  return scene;
}

Avatar golden_avatar() {
  auto avatar = stamped<Avatar>();
  avatar.name = *AvatarName::parse("fox-2");
  avatar.colour_rgb = {0.125f, 0.25f, 1.0f};
  avatar.height_scale = 1.5f;
  return avatar;
}

AvatarFile golden_avatar_file() {
  auto file = stamped<AvatarFile>();
  for (std::size_t i = 0; i < file.hash.bytes.size(); ++i)
    file.hash.bytes[i] = static_cast<std::uint8_t>(7 * i + 1);
  file.size_bytes = 1'234'567;
  EXPECT_TRUE(file.name.assign("M\xc3\xa4rchen.vrm"));
  return file;
}

Style golden_style() {
  auto style = stamped<Style>();
  style.gain = {1.25f, 0.5f, 0.75f, 2.0f, 3.0f, 1.0f, 0.25f};
  style.periodic = 1.5f;
  style.dynamic = 0.5f;
  return style;
}

Placement golden_placement() {
  auto placement = stamped<Placement>();
  placement.x_m = -1.5f;
  placement.z_m = 2.25f;
  placement.heading_rad = -1.75f;
  return placement;
}

Beat golden_beat() {
  auto beat = stamped<Beat>();
  beat.beat_time = MonoTime::from_us(1'234'567'890'373);
  beat.beat = 127.0;
  beat.tempo_bpm = 184.25;
  beat.beats_per_bar = 8;
  beat.confidence = 0.75f;
  beat.playing = true;
  return beat;
}

FlowSetting golden_flow() {
  auto flow = stamped<FlowSetting>();
  flow.has = {false, true, true, true, true};
  flow.on = {true, true, false, true, false};
  flow.own = true;
  flow.route = 3;
  flow.hold_ms = 20.5f;
  flow.lead = 0.75f;
  flow.reach_ms = 250.5f;
  flow.rhythm_beats = 1.0f;
  flow.rhythm_count = 4.0f;
  flow.rhythm_strength = 0.5f;
  flow.rhythm_error_mm = 80.25f;
  flow.gain = {1.25f, 0.5f, 0.75f, 2.0f, 3.0f, 1.0f, 0.25f};
  flow.periodic = 0.5f;
  flow.dynamic = 0.25f;
  flow.guest_gain = {1.5f, 1.0f, 1.0f, 1.25f, 1.0f, 0.5f, 0.75f};
  flow.guest_dynamic = 0.75f;
  return flow;
}

Playout golden_playout() {
  auto playout = stamped<Playout>();
  playout.reason = PlayoutReason::kGoodEnough;
  playout.beats = 1.0f;
  playout.delay_ms = 187.25f;
  playout.ahead_ms = -12.5f;
  playout.error_mm = 58.5f;
  playout.limit_mm = 60.0f;
  playout.partner_share = 0.75f;
  playout.partner = *GuestId::parse("alice");
  return playout;
}

Steps golden_steps() {
  auto steps = stamped<Steps>();
  steps.tempo_bpm = 96.5;
  steps.weight = 0.75f;
  steps.dancers = 2;
  steps.is_remote = true;
  return steps;
}

Touch golden_touch() {
  auto touch = stamped<Touch>();
  touch.contact = 0x80000003u;
  touch.phase = TouchPhase::kLasts;
  touch.is_hold = true;
  touch.bone = Bone::kRightHand;
  touch.other_bone = Bone::kLeftHand;
  touch.depth_m = 0.0625f;
  touch.force_n = 12.5f;
  touch.approach_m_s = -0.25f;
  touch.motion_m_s = {0.5f, -1.5f, 2.25f};
  touch.place_m = {-1.25f, 1.125f, 3.5f};
  touch.other = *GuestId::parse("alice");
  return touch;
}

Haptic golden_haptic() {
  auto haptic = stamped<Haptic>();
  haptic.maker = 0xfedcba9876543210u;
  haptic.number = 4'000'000'001u;
  haptic.play_time = haptic.time + Duration::us(123'456);
  haptic.duration = Duration::us(250'001);
  haptic.attack = Duration::us(5'002);
  haptic.release = Duration::us(60'003);
  haptic.source = HapticSource::kLead;
  haptic.bone = Bone::kRightHand;
  haptic.amplitude = 0.75f;
  haptic.frequency_hz = 170.5f;
  return haptic;
}

TEST(GoldenState, IsWrittenAndReadByteForByte) {
  expect_golden("music_t", golden_music());
  expect_golden("song_t", golden_song());
  expect_golden("profile_t", golden_profile());
  expect_golden("scene_t", golden_scene());
  expect_golden("avatar_t", golden_avatar());
  expect_golden("avatar_file_t", golden_avatar_file());
  expect_golden("style_t", golden_style());
  expect_golden("placement_t", golden_placement());
  expect_golden("beat_t", golden_beat());
  expect_golden("flow_t", golden_flow());
  expect_golden("playout_t", golden_playout());
  expect_golden("steps_t", golden_steps());
  expect_golden("touch_t", golden_touch());
  expect_golden("haptic_t", golden_haptic());
}

TEST(GoldenState, SurvivesEverySingleBitFlip) {
  expect_survives_bit_flips<Music>("music_t");
  expect_survives_bit_flips<RoomSong>("song_t");
  expect_survives_bit_flips<Profile>("profile_t");
  expect_survives_bit_flips<Scene>("scene_t");
  expect_survives_bit_flips<Avatar>("avatar_t");
  expect_survives_bit_flips<AvatarFile>("avatar_file_t");
  expect_survives_bit_flips<Style>("style_t");
  expect_survives_bit_flips<Placement>("placement_t");
  expect_survives_bit_flips<Beat>("beat_t");
  expect_survives_bit_flips<FlowSetting>("flow_t");
  expect_survives_bit_flips<Playout>("playout_t");
  expect_survives_bit_flips<Steps>("steps_t");
  expect_survives_bit_flips<Touch>("touch_t");
  expect_survives_bit_flips<Haptic>("haptic_t");
}

TEST(GoldenState, IsSmallEnoughForTheTunnel) {
  for (const char* type :
       {"music_t", "song_t", "scene_t", "avatar_t", "avatar_file_t", "style_t", "placement_t"})
    EXPECT_LE(read_golden(type).size(), 400u) << type;
}

TEST(GoldenState, TellsALateJoinerTheBar) {
  const Bytes golden = read_golden("music_t");
  Music music;
  ASSERT_EQ(decode(golden.data(), golden.size(), music), Decoded::kFine);
  EXPECT_EQ(music.title.view(), "Fr\xc3\xbchling in Havanna");
  const MonoTime later = MonoTime::from_us(1'234'567'000'000 + 60'000'000);
  EXPECT_DOUBLE_EQ(music.beats_at(later), -2.5 + 184.25);
  music.playing = false;
  EXPECT_DOUBLE_EQ(music.beats_at(later), -2.5);
}

template <class T, class Change>
Decoded outcome_of(T value, Change change) {
  change(value);
  const Bytes bytes = encoded(value);
  T decoded;
  return decode(bytes.data(), bytes.size(), decoded);
}

TEST(DecodeState, CallsImpossibleValuesInvalid) {
  const auto fine = Decoded::kFine, invalid = Decoded::kInvalid;
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(outcome_of(golden_music(), [](Music&) {}), fine);
  EXPECT_EQ(outcome_of(golden_music(), [](Music& m) { m.tempo_bpm = 0.0; }), invalid);
  EXPECT_EQ(outcome_of(golden_music(), [&](Music& m) { m.tempo_bpm = nan; }), invalid);
  EXPECT_EQ(outcome_of(golden_music(), [&](Music& m) { m.start_beats = nan; }), invalid);
  EXPECT_EQ(outcome_of(golden_music(), [](Music& m) { m.start_beats = 1e12; }), invalid);
  EXPECT_EQ(outcome_of(golden_music(), [](Music& m) { m.beats_per_bar = 0; }), invalid);
  EXPECT_EQ(outcome_of(golden_music(),
                       [](Music& m) {
                         m.start_time = MonoTime::from_ns(std::numeric_limits<std::int64_t>::max());
                       }),
            invalid);
  for (const char* title :
       {"\x1b[2J", "a\nb", "\xff", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
        "\xc2\x9b", "\x7f", "\u202egpj.song", "a\u2066b", "a\u200fb"})
    EXPECT_EQ(outcome_of(golden_music(), [&](Music& m) { EXPECT_TRUE(m.title.assign(title)); }),
              invalid)
        << title;
  for (const char* title : {"", "Guantanamera", "\xe2\x99\xab", "\xf0\x9f\x92\x83"})
    EXPECT_EQ(outcome_of(golden_music(), [&](Music& m) { EXPECT_TRUE(m.title.assign(title)); }),
              fine)
        << title;
  for (const char* name : {" Ana", "Ana ", " ", "\xff", "A\u202enA", "\x1b[2J", "\u3164"})
    EXPECT_EQ(
        outcome_of(golden_profile(), [&](Profile& p) { EXPECT_TRUE(p.shown_name.assign(name)); }),
        invalid)
        << name;
  for (const char* name : {"", "Ana Luc\u00eda", "\U0001f483"})
    EXPECT_EQ(
        outcome_of(golden_profile(), [&](Profile& p) { EXPECT_TRUE(p.shown_name.assign(name)); }),
        fine)
        << name;
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong&) {}), fine);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.style = RoomSong::kStyles; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.start_beat = -1; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_count = 0; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_count = 17; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_bar[0] = 1; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_bar[2] = 8; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_bar[2] = 10000; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_centi_bpm[1] = 2999; }), invalid);
  EXPECT_EQ(outcome_of(golden_song(), [](RoomSong& s) { s.tempo_centi_bpm[3] = 9000; }), invalid);
  EXPECT_EQ(outcome_of(golden_scene(), [](Scene& s) { s.floor_width_m = 0.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_scene(), [](Scene& s) { s.light_rgb[2] = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_scene(), [](Scene& s) { s.brightness = 1.5f; }), invalid);
  EXPECT_EQ(outcome_of(golden_scene(), [](Scene& s) { s.name = SceneName(); }), fine);
  EXPECT_EQ(outcome_of(golden_avatar(), [](Avatar& a) { a.height_scale = 0.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_avatar(), [](Avatar& a) { a.colour_rgb[0] = -1.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_avatar_file(), [](AvatarFile&) {}), fine);
  EXPECT_EQ(outcome_of(golden_avatar_file(), [](AvatarFile& f) { f = AvatarFile(); }), fine);
  EXPECT_EQ(outcome_of(golden_avatar_file(),
                       [](AvatarFile& f) { EXPECT_TRUE(f.name.assign("me\u202emrv.glb")); }),
            invalid);
  for (const int size : {0, -1, (16 << 20) + 1})
    EXPECT_EQ(outcome_of(golden_avatar_file(), [&](AvatarFile& f) { f.size_bytes = size; }),
              invalid)
        << size;
  EXPECT_EQ(outcome_of(golden_avatar_file(), [](AvatarFile& f) { f.hash = FileHash(); }), invalid);
  EXPECT_EQ(outcome_of(golden_avatar_file(),
                       [](AvatarFile& f) { EXPECT_TRUE(f.name.assign("\x1b[2J")); }),
            invalid);
  EXPECT_EQ(outcome_of(golden_style(), [](Style& s) { s.gain[6] = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_style(), [](Style& s) { s.dynamic = 5.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_placement(), [](Placement& p) { p.x_m = 1e6f; }), invalid);
  EXPECT_EQ(outcome_of(golden_placement(), [](Placement& p) { p.heading_rad = 4.0f; }), invalid);
}

TEST(DecodeState, CallsImpossibleFlowsInvalid) {
  const auto fine = Decoded::kFine, invalid = Decoded::kInvalid;
  using F = FlowSetting;
  EXPECT_EQ(outcome_of(golden_flow(), [](F&) {}), fine);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.lead = 1.51f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.lead = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.reach_ms = -1.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.hold_ms = 2001.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.rhythm_beats = 9.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.rhythm_count = 0.0f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.rhythm_strength = 1.1f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.rhythm_error_mm = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.gain[6] = 4.1f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.guest_gain[0] = -0.1f; }), invalid);
  EXPECT_EQ(outcome_of(golden_flow(), [](F& f) { f.route = 100'000; }), invalid);
}

TEST(DecodeState, CallsImpossiblePlayoutsInvalid) {
  const auto fine = Decoded::kFine, invalid = Decoded::kInvalid;
  using P = Playout;
  EXPECT_EQ(outcome_of(golden_playout(), [](P&) {}), fine);
  EXPECT_EQ(outcome_of(golden_playout(), [](P& p) { p = P(); }), fine);  // nothing is known
  EXPECT_EQ(outcome_of(golden_playout(),
                       [](P& p) { p.reason = static_cast<PlayoutReason>(kPlayoutReasons); }),
            invalid);
  EXPECT_EQ(outcome_of(golden_playout(), [](P& p) { p.reason = static_cast<PlayoutReason>(200); }),
            invalid);
  EXPECT_EQ(outcome_of(golden_playout(), [](P& p) { p.beats = 1e9f; }), invalid);
  EXPECT_EQ(outcome_of(golden_playout(), [](P& p) { p.partner_share = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_playout(), [](P& p) { p.partner_share = 1.5f; }), invalid);
}

TEST(DecodeState, CallsImpossibleStepsInvalid) {
  const auto fine = Decoded::kFine, invalid = Decoded::kInvalid;
  using S = Steps;
  EXPECT_EQ(outcome_of(golden_steps(), [](S&) {}), fine);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.tempo_bpm = 0.0, s.weight = 0.0f; }), fine);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.tempo_bpm = 0.0; }), invalid);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.tempo_bpm = 1e9; }), invalid);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.tempo_bpm = -96.0; }), invalid);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.weight = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.weight = 1.5f; }), invalid);
  EXPECT_EQ(outcome_of(golden_steps(), [](S& s) { s.dancers = -1; }), invalid);
}

TEST(DecodeState, CallsImpossibleBeatsInvalid) {
  const auto fine = Decoded::kFine, invalid = Decoded::kInvalid;
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat&) {}), fine);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.beats_per_bar = 0; }), fine);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.beats_per_bar = 17; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.beats_per_bar = -1; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [&](Beat& b) { b.beat = nan; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.beat = 2e7; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.tempo_bpm = 19.0; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [&](Beat& b) { b.tempo_bpm = nan; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.confidence = kNan; }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.beat_time += Duration::s(61); }), invalid);
  EXPECT_EQ(outcome_of(golden_beat(), [](Beat& b) { b.beat_time += Duration::s(-61); }), invalid);
}

TEST(DecodeState, RefusesTextsThatGoOnBehindTheirEndAndNamesThatAreNone) {
  Bytes bytes = read_golden("avatar_t");
  const std::size_t name = 8 + 8 + 8;
  Avatar avatar;
  bytes[name + 31] = 'x';  // behind the zeros
  EXPECT_EQ(decode(bytes.data(), bytes.size(), avatar), Decoded::kInvalid);
  bytes = read_golden("avatar_t");
  bytes[name] = '/';
  EXPECT_EQ(decode(bytes.data(), bytes.size(), avatar), Decoded::kInvalid);
  for (std::size_t i = 0; i < 32; ++i) bytes[name + i] = 'a';  // no end
  EXPECT_EQ(decode(bytes.data(), bytes.size(), avatar), Decoded::kInvalid);
}

TEST(DecodeState, AllocatesNothing) {
  const Music music = golden_music();
  MessageBuffer buffer;
  Music decoded;
  const AllocationGuard guard;
  const std::size_t size = encode(music, buffer);
  EXPECT_EQ(decode(buffer.data(), size, decoded), Decoded::kFine);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
