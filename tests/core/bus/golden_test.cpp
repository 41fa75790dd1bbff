// One message of each type as it must stay on the wire and in logs for ever. The files were encoded
// from the .lcm files by another program than ours, so that a mistake on our side cannot hide in
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "core/bus/encode.h"
#include "tests/allocation_guard.h"
#include "tests/core/bus/golden_files.h"

namespace dance {
namespace {

constexpr std::uint32_t kSequence = 4'000'000'000u;

Eigen::Quaternionf rotation(std::size_t i) {
  switch (i % 4) {
    case 0:
      return {0.5f, 0.5f, -0.5f, 0.5f};
    case 1:
      return {1.0f, 0.0f, 0.0f, 0.0f};
    case 2:
      return {0.8f, 0.6f, 0.0f, 0.0f};
    default:
      return {0.6f, 0.0f, -0.8f, 0.0f};
  }
}
MonoTime hop(std::size_t i) {
  return MonoTime::from_us(1'234'567'891'000 + static_cast<std::int64_t>(i) * 1000);
}

Pose golden_pose() {
  Pose pose;
  for (std::size_t i = 0; i < kBoneCount; ++i) pose.R_PB[i] = rotation(i);
  for (std::size_t i = 0; i < kHopCount; ++i) pose.hops[i] = hop(i);
  pose.p_WH_m = {1.25f, 0.9375f, -2.5f};
  pose.presence = 0x2aaaaa;
  pose.confidence = 0.75f;
  pose.sequence = kSequence;
  pose.clock_id = kClock;
  pose.capture_time = kCaptured;
  pose.music_beats = 128.5;
  return pose;
}

Hands golden_hands() {
  Hands hands;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) hands.R_PB[i] = rotation(i);
  hands.presence = 0x15555555;
  hands.sequence = kSequence;
  hands.clock_id = kClock;
  hands.capture_time = kCaptured;
  return hands;
}

TimedSkeleton golden_skeleton() {
  TimedSkeleton timed;
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const auto k = static_cast<float>(i);
    timed.skeleton.offset_m[i] = {0.0078125f * k, -0.015625f * k, 0.03125f};
  }
  for (std::size_t i = 0; i < kTipCount; ++i)
    timed.skeleton.tip_m[i] = {0.0f, 0.125f * static_cast<float>(i), -0.25f};
  timed.skeleton.version = 3;
  timed.capture_time = kCaptured;
  timed.clock_id = kClock;
  return timed;
}

GuestStatus golden_guest() {
  GuestStatus status;
  status.time = kCaptured;
  status.clock_id = kClock;
  status.alive = status.remote = true;
  status.arrival_hz = 59.5f;
  status.stage_hz = 60.25f;
  status.age_p50_ms = 41.5f;
  status.age_p99_ms = 77.75f;
  status.received = 123'456'789'012;
  status.lost = 321;
  return status;
}

StageTime golden_stage_time() {
  StageTime time;
  time.clock_id = kClock;
  time.sequence = kSequence;
  time.capture_time = kCaptured;
  for (std::size_t i = 0; i < kHopCount; ++i) time.hops[i] = hop(i);
  time.heard_time = MonoTime::from_us(1'234'567'898'000);
  time.swap_time = MonoTime::from_us(1'234'567'899'000);
  return time;
}

// The field at place i of stats_t is 10^12 + i, but for the clock and its offset.
Stats golden_stats() {
  constexpr std::int64_t k = 1'000'000'000'000;
  Stats s;
  s.time = MonoTime::from_us(k);
  s.clock_id = kClock;
  s.uptime = Duration::us(k + 2);
  std::int64_t* const counters[] = {
      &s.received,           &s.forwarded,        &s.superseded,       &s.dropped_late,
      &s.dropped_invalid,    &s.dropped_unrouted, &s.dropped_overflow, &s.lost,
      &s.bytes_in,           &s.bytes_out,        &s.datagrams_in,     &s.datagrams_out,
      &s.rejected_datagrams, &s.guests,           &s.sessions,         &s.reconnects};
  std::int64_t place = 3;
  for (std::int64_t* counter : counters) *counter = k + place++;
  s.round_trip = Duration::us(k + 19);
  s.clock_offset = Duration::us(-(k + 20));
  s.lateness_p99 = Duration::us(k + 21);
  return s;
}

GuestStats golden_guest_stats() {
  GuestStats s;
  s.time = kCaptured;
  s.clock_id = kClock;
  s.gap_p50_ms = {0.25f, 1.5f, 20.5f, 30.25f, kNotKnown, 0.125f, 0.5f, 8.25f};
  s.gap_p99_ms = {0.5f, 2.5f, 40.5f, 60.25f, kNotKnown, 0.25f, 1.5f, 16.5f};
  s.newest_p50_ms = 61.375f;
  s.newest_p99_ms = 122.0f;
  s.age_p50_ms = -3.25f;
  s.age_p99_ms = 12.5f;
  s.arrival_hz = 59.5f;
  s.stage_hz = 60.0f;
  s.shown_hz = 58.25f;
  s.jitter_ms = 2.75f;
  s.loss_percent = 1.25f;
  s.horizon_p50_ms = 64.625f;
  s.horizon_p99_ms = 90.5f;
  s.error_mean_mm = 18.5f;
  s.error_p95_mm = 44.25f;
  s.hips_error_mm = 9.75f;
  s.beat_ms = -12.5f;
  s.beat_share = -0.03125f;
  s.bytes_per_second = 4096.0f;
  s.bytes_per_pose = 68.25f;
  s.received = 123'456;
  s.lost = 12;
  s.late = 3;
  s.superseded = 45;
  return s;
}

GuestTraffic golden_guest_traffic() {
  GuestTraffic t;
  t.time = kCaptured;
  t.clock_id = kClock;
  t.bytes = 987'654'321;
  t.received = 123'456;
  t.lost = 12;
  t.late = 3;
  t.duplicate = 7;
  t.invalid = 2;
  t.reference_missing = 5;
  t.key_frames_asked = 4;
  return t;
}

Voice golden_voice() {
  Voice voice;
  voice.capture_time = kCaptured;
  voice.clock_id = kClock;
  voice.sequence = kSequence;
  voice.level_dbfs = -23;
  Bytes packet(81);
  for (std::size_t i = 0; i < packet.size(); ++i) packet[i] = static_cast<std::uint8_t>(3 * i + 1);
  EXPECT_TRUE(voice.set_packet(packet));
  return voice;
}

HearingWish golden_hearing() {
  HearingWish wish;
  wish.time = kCaptured;
  wish.clock_id = kClock;
  wish.listener = *GuestId::parse("dora");
  wish.hears_others = true;
  wish.guests[0] = *GuestId::parse("alice");
  wish.guests[15] = *GuestId::parse("bob-2");
  return wish;
}

VoiceState golden_voice_state() {
  VoiceState state;
  state.time = kCaptured;
  state.clock_id = kClock;
  state.is_muted = true;
  state.is_deafened = false;
  state.is_push_to_talk = true;
  state.is_heard = false;
  state.has_microphone = true;
  state.has_loudspeaker = false;
  return state;
}

TEST(GoldenMessages, KeepFiguresThatAreNotKnownAndRefuseInfiniteOnes) {
  GuestStats stats = golden_guest_stats(), decoded;
  stats.jitter_ms = kNotKnown;
  Bytes bytes = encoded(stats);
  ASSERT_EQ(decode(bytes.data(), bytes.size(), decoded), Decoded::kFine);
  EXPECT_TRUE(std::isnan(decoded.jitter_ms));
  EXPECT_TRUE(std::isnan(decoded.gap_p50_ms[4]));
  EXPECT_EQ(decoded.gap_p99_ms[7], 16.5f);
  stats.gap_p99_ms[2] = std::numeric_limits<float>::infinity();
  bytes = encoded(stats);
  EXPECT_EQ(decode(bytes.data(), bytes.size(), decoded), Decoded::kInvalid);
  GuestTraffic traffic = golden_guest_traffic(), read;
  traffic.bytes = -1;
  bytes = encoded(traffic);
  EXPECT_EQ(decode(bytes.data(), bytes.size(), read), Decoded::kInvalid);
}

TEST(GoldenMessages, AreWrittenAndReadByteForByte) {
  expect_golden("pose_t", golden_pose());
  expect_golden("hands_t", golden_hands());
  expect_golden("skeleton_t", golden_skeleton());
  expect_golden("guest_t", golden_guest());
  expect_golden("stage_time_t", golden_stage_time());
  expect_golden("stats_t", golden_stats());
  expect_golden("guest_stats_t", golden_guest_stats());
  expect_golden("guest_traffic_t", golden_guest_traffic());
  expect_golden("voice_t", golden_voice());
  expect_golden("hearing_t", golden_hearing());
  expect_golden("voice_state_t", golden_voice_state());
}

TEST(GoldenMessages, HoldThePoseThatWasDanced) {
  const Bytes golden = read_golden("pose_t");
  Pose pose;
  ASSERT_EQ(decode(golden.data(), golden.size(), pose), Decoded::kFine);
  const Pose expected = golden_pose();
  EXPECT_EQ(pose.capture_time, kCaptured);
  EXPECT_EQ(pose.clock_id, kClock);
  EXPECT_EQ(pose.sequence, kSequence);
  EXPECT_EQ(pose.presence, 0x2aaaaau);
  EXPECT_EQ(pose.hops, expected.hops);
  EXPECT_EQ(pose.p_WH_m, expected.p_WH_m);
  EXPECT_EQ(pose.confidence, 0.75f);
  EXPECT_EQ(pose.music_beats, 128.5);
  for (std::size_t i = 0; i < kBoneCount; ++i)
    EXPECT_TRUE(pose.R_PB[i].coeffs().isApprox(expected.R_PB[i].coeffs(), 1e-6f)) << i;
}

TEST(GoldenMessages, HaveTheFingerprintsAndSizesOfTheReadme) {
  std::ifstream readme(std::string(DANCE_SOURCE_DIR) + "/lcmtypes/README.md");
  const std::string text{std::istreambuf_iterator<char>(readme), std::istreambuf_iterator<char>()};
  for_each_message_type([&]<class Message>() {
    const std::string type(MessageTraits<Message>::type_name());
    const Bytes golden = read_golden(type);
    ASSERT_GE(golden.size(), 8u);
    std::string fingerprint;
    for (int i = 0; i < 8; ++i) {
      constexpr std::string_view kDigits = "0123456789abcdef";
      fingerprint += kDigits[golden[static_cast<std::size_t>(i)] >> 4];
      fingerprint += kDigits[golden[static_cast<std::size_t>(i)] & 15];
    }
    const std::string row =
        "| `" + type + "` | `" + fingerprint + "` | " + std::to_string(golden.size()) + " |";
    EXPECT_NE(text.find(row), std::string::npos) << row;
  });
}

TEST(GoldenDecode, RefusesEveryOtherLengthAndType) {
  const Bytes golden = read_golden("pose_t");
  Pose pose;
  for (std::size_t size = 0; size < golden.size(); ++size) {
    const Bytes cut(golden.begin(), golden.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(decode(cut.data(), cut.size(), pose), Decoded::kUndecodable) << size;
  }
  Bytes longer = golden;
  longer.push_back(0);
  EXPECT_EQ(decode(longer.data(), longer.size(), pose), Decoded::kUndecodable);
  longer.resize(100'000);
  EXPECT_EQ(decode(longer.data(), longer.size(), pose), Decoded::kUndecodable);
  for (const char* other : {"hands_t", "skeleton_t", "guest_t", "stage_time_t", "stats_t"}) {
    const Bytes bytes = read_golden(other);
    EXPECT_EQ(decode(bytes.data(), bytes.size(), pose), Decoded::kUndecodable) << other;
  }
}

TEST(GoldenDecode, SurvivesEverySingleBitFlip) {
  expect_survives_bit_flips<Pose>("pose_t");
  expect_survives_bit_flips<Hands>("hands_t");
  expect_survives_bit_flips<TimedSkeleton>("skeleton_t");
  expect_survives_bit_flips<GuestStatus>("guest_t");
  expect_survives_bit_flips<StageTime>("stage_time_t");
  expect_survives_bit_flips<Stats>("stats_t");
  expect_survives_bit_flips<Voice>("voice_t");
  expect_survives_bit_flips<HearingWish>("hearing_t");
  expect_survives_bit_flips<VoiceState>("voice_state_t");
}

TEST(GoldenDecode, CallsImpossibleValuesInvalid) {
  const auto outcome_of = [](const Pose& pose) {
    const Bytes bytes = encoded(pose);
    Pose decoded;
    return decode(bytes.data(), bytes.size(), decoded);
  };
  Pose pose = golden_pose();
  EXPECT_EQ(outcome_of(pose), Decoded::kFine);
  pose.R_PB[21].z() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(outcome_of(pose), Decoded::kInvalid);
  pose = golden_pose();
  pose.p_WH_m.y() = 1e9f;
  EXPECT_EQ(outcome_of(pose), Decoded::kInvalid);
  pose = golden_pose();
  pose.capture_time = MonoTime::from_ns(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(outcome_of(pose), Decoded::kInvalid);
  pose = golden_pose();
  pose.hops[3] = MonoTime::from_ns(std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(outcome_of(pose), Decoded::kInvalid);
  pose = golden_pose();
  pose.music_beats = kNoMusic;
  EXPECT_EQ(outcome_of(pose), Decoded::kFine);
}

TEST(GoldenDecode, AcceptsVoiceOfAnySizeUpToItsBoundWithAnyBytes) {
  const auto outcome_of = [](auto change) {
    Voice voice = golden_voice(), decoded;
    change(voice);
    const Bytes bytes = encoded(voice);
    return decode(bytes.data(), bytes.size(), decoded);
  };
  const Bytes longest(kMaxVoiceBytes, 0xff);
  Voice voice = golden_voice();
  EXPECT_TRUE(voice.set_packet(std::span(longest).first(1)));
  EXPECT_EQ(voice.packet().size(), 1u);
  EXPECT_TRUE(is_valid(voice)) << "what stood there before is gone";
  EXPECT_FALSE(voice.set_packet({}));
  EXPECT_FALSE(voice.set_packet(Bytes(kMaxVoiceBytes + 1)));
  EXPECT_EQ(voice.packet().size(), 1u);
  EXPECT_EQ(outcome_of([&](Voice& v) { EXPECT_TRUE(v.set_packet(longest)); }), Decoded::kFine);
  EXPECT_EQ(outcome_of([](Voice& v) { v.level_dbfs = 0; }), Decoded::kFine);
  EXPECT_EQ(outcome_of([](Voice& v) { v.level_dbfs = 1; }), Decoded::kInvalid);
  EXPECT_EQ(outcome_of([](Voice& v) { v.level_dbfs = -128; }), Decoded::kInvalid);
  for (const int size : {0, -1, 161, 32'767, -32'768, 80})
    EXPECT_EQ(outcome_of([size](Voice& v) { v.size_bytes = size; }), Decoded::kInvalid) << size;
}

TEST(GoldenDecode, RefusesAHearingRequestWithoutAListener) {
  HearingWish wish = golden_hearing(), decoded;
  wish.listener = GuestId();
  const Bytes bytes = encoded(wish);
  EXPECT_EQ(decode(bytes.data(), bytes.size(), decoded), Decoded::kInvalid);
}

TEST(GoldenDecode, AllocatesNothing) {
  const Pose pose = golden_pose();
  MessageBuffer buffer;
  Pose decoded;
  const AllocationGuard guard;
  const std::size_t size = encode(pose, buffer);
  EXPECT_EQ(decode(buffer.data(), size, decoded), Decoded::kFine);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
