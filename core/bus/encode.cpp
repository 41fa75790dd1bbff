#include "core/bus/encode.h"

#include <cmath>
#include <dancelcm/guest_t.hpp>
#include <dancelcm/hands_t.hpp>
#include <dancelcm/pose_t.hpp>
#include <dancelcm/skeleton_t.hpp>
#include <dancelcm/stage_time_t.hpp>
#include <dancelcm/stats_t.hpp>
#include <iterator>

#include "core/bus/message_bytes.h"

namespace dance {
namespace {

// lcm-gen takes only literal sizes: these tie them to the code.
static_assert(std::size(decltype(dancelcm::pose_t::rotation_xyzw){}) == kBoneCount);
static_assert(std::size(decltype(dancelcm::pose_t::hop_time_us){}) == kHopCount);
static_assert(std::size(decltype(dancelcm::stage_time_t::hop_time_us){}) == kHopCount);
static_assert(std::size(decltype(dancelcm::hands_t::rotation_xyzw){}) == kFingerBoneCount);
static_assert(std::size(decltype(dancelcm::skeleton_t::offset_m){}) == kBoneCount);
static_assert(std::size(decltype(dancelcm::skeleton_t::tip_m){}) == kTipCount);

void put_rotation(float (&xyzw)[4], const Eigen::Quaternionf& q) {
  xyzw[0] = q.x();
  xyzw[1] = q.y();
  xyzw[2] = q.z();
  xyzw[3] = q.w();
}
Eigen::Quaternionf get_rotation(const float (&xyzw)[4]) {
  return Eigen::Quaternionf(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
}
void put_vector(float (&out)[3], const Eigen::Vector3f& v) {
  for (int i = 0; i < 3; ++i) out[i] = v[i];
}
Eigen::Vector3f get_vector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace

std::size_t encode(const RawPose& raw, MessageBuffer& buffer) {
  const Pose& pose = raw.pose;
  dancelcm::pose_t m{};
  m.capture_time_us = raw.capture_time_us;
  m.clock_id = static_cast<std::int64_t>(pose.clock_id);
  for (std::size_t i = 0; i < kHopCount; ++i) m.hop_time_us[i] = raw.hop_time_us[i];
  m.sequence = static_cast<std::int32_t>(pose.sequence);
  m.presence = static_cast<std::int32_t>(pose.presence);
  for (std::size_t i = 0; i < kBoneCount; ++i) put_rotation(m.rotation_xyzw[i], pose.R_PB[i]);
  put_vector(m.hips_m, pose.p_WH_m);
  m.confidence = pose.confidence;
  m.music_beats = pose.music_beats;
  return pack(m, buffer);
}

bool decode_unchecked(const void* data, std::size_t size, RawPose& raw) {
  dancelcm::pose_t m{};
  if (!unpack(data, size, m)) return false;
  raw.capture_time_us = m.capture_time_us;
  for (std::size_t i = 0; i < kHopCount; ++i) raw.hop_time_us[i] = m.hop_time_us[i];
  Pose& pose = raw.pose;
  pose.clock_id = static_cast<std::uint64_t>(m.clock_id);
  pose.sequence = static_cast<std::uint32_t>(m.sequence);
  pose.presence = static_cast<std::uint32_t>(m.presence);
  for (std::size_t i = 0; i < kBoneCount; ++i) pose.R_PB[i] = get_rotation(m.rotation_xyzw[i]);
  pose.p_WH_m = get_vector(m.hips_m);
  pose.confidence = m.confidence;
  pose.music_beats = m.music_beats;
  return true;
}

std::size_t encode(const Pose& pose, MessageBuffer& buffer) {
  RawPose raw{pose, to_us(pose.capture_time), {}};
  for (std::size_t i = 0; i < kHopCount; ++i) raw.hop_time_us[i] = to_us(pose.hops[i]);
  return encode(raw, buffer);
}

Decoded decode(const void* data, std::size_t size, Pose& pose) {
  RawPose raw;
  if (!decode_unchecked(data, size, raw)) return Decoded::kUndecodable;
  if (!is_time(raw.capture_time_us)) return Decoded::kInvalid;
  raw.pose.capture_time = from_us(raw.capture_time_us);
  for (std::size_t i = 0; i < kHopCount; ++i) {
    if (!is_time(raw.hop_time_us[i])) return Decoded::kInvalid;
    raw.pose.hops[i] = from_us(raw.hop_time_us[i]);
  }
  raw.pose.presence &= kAllBones;
  if (!is_valid(raw.pose)) return Decoded::kInvalid;
  pose = raw.pose;
  normalize(pose);
  return Decoded::kFine;
}

std::size_t encode(const RawHands& raw, MessageBuffer& buffer) {
  const Hands& hands = raw.hands;
  dancelcm::hands_t m{};
  m.capture_time_us = raw.capture_time_us;
  m.clock_id = static_cast<std::int64_t>(hands.clock_id);
  m.sequence = static_cast<std::int32_t>(hands.sequence);
  m.presence = static_cast<std::int32_t>(hands.presence);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    put_rotation(m.rotation_xyzw[i], hands.R_PB[i]);
  return pack(m, buffer);
}

bool decode_unchecked(const void* data, std::size_t size, RawHands& raw) {
  dancelcm::hands_t m{};
  if (!unpack(data, size, m)) return false;
  raw.capture_time_us = m.capture_time_us;
  Hands& hands = raw.hands;
  hands.clock_id = static_cast<std::uint64_t>(m.clock_id);
  hands.sequence = static_cast<std::uint32_t>(m.sequence);
  hands.presence = static_cast<std::uint32_t>(m.presence);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    hands.R_PB[i] = get_rotation(m.rotation_xyzw[i]);
  return true;
}

std::size_t encode(const Hands& hands, MessageBuffer& buffer) {
  return encode(RawHands{hands, to_us(hands.capture_time)}, buffer);
}

Decoded decode(const void* data, std::size_t size, Hands& hands) {
  RawHands raw;
  if (!decode_unchecked(data, size, raw)) return Decoded::kUndecodable;
  if (!is_time(raw.capture_time_us)) return Decoded::kInvalid;
  raw.hands.capture_time = from_us(raw.capture_time_us);
  raw.hands.presence &= (1u << kFingerBoneCount) - 1;
  if (!is_valid(raw.hands)) return Decoded::kInvalid;
  hands = raw.hands;
  normalize(hands);
  return Decoded::kFine;
}

std::size_t encode(const TimedSkeleton& timed, MessageBuffer& buffer) {
  dancelcm::skeleton_t m{};
  m.capture_time_us = to_us(timed.capture_time);
  m.clock_id = static_cast<std::int64_t>(timed.clock_id);
  m.version = static_cast<std::int32_t>(timed.skeleton.version);
  for (std::size_t i = 0; i < kBoneCount; ++i)
    put_vector(m.offset_m[i], timed.skeleton.offset_m[i]);
  for (std::size_t i = 0; i < kTipCount; ++i) put_vector(m.tip_m[i], timed.skeleton.tip_m[i]);
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, TimedSkeleton& timed) {
  dancelcm::skeleton_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  if (!is_time(m.capture_time_us)) return Decoded::kInvalid;
  timed.capture_time = from_us(m.capture_time_us);
  timed.clock_id = static_cast<std::uint64_t>(m.clock_id);
  timed.skeleton.version = static_cast<std::uint32_t>(m.version);
  for (std::size_t i = 0; i < kBoneCount; ++i)
    timed.skeleton.offset_m[i] = get_vector(m.offset_m[i]);
  for (std::size_t i = 0; i < kTipCount; ++i) timed.skeleton.tip_m[i] = get_vector(m.tip_m[i]);
  return is_valid(timed.skeleton) ? Decoded::kFine : Decoded::kInvalid;
}

std::size_t encode(const GuestStatus& status, MessageBuffer& buffer) {
  dancelcm::guest_t m{};
  m.time_us = to_us(status.time);
  m.clock_id = static_cast<std::int64_t>(status.clock_id);
  m.alive = status.alive ? 1 : 0;
  m.remote = status.remote ? 1 : 0;
  m.arrival_hz = status.arrival_hz;
  m.stage_hz = status.stage_hz;
  m.age_p50_ms = status.age_p50_ms;
  m.age_p99_ms = status.age_p99_ms;
  m.received = status.received;
  m.lost = status.lost;
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, GuestStatus& status) {
  dancelcm::guest_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  for (const float rate : {m.arrival_hz, m.stage_hz, m.age_p50_ms, m.age_p99_ms})
    if (!std::isfinite(rate)) return Decoded::kInvalid;
  if (!is_time(m.time_us)) return Decoded::kInvalid;
  status.time = from_us(m.time_us);
  status.clock_id = static_cast<std::uint64_t>(m.clock_id);
  status.alive = m.alive != 0;
  status.remote = m.remote != 0;
  status.arrival_hz = m.arrival_hz;
  status.stage_hz = m.stage_hz;
  status.age_p50_ms = m.age_p50_ms;
  status.age_p99_ms = m.age_p99_ms;
  status.received = m.received;
  status.lost = m.lost;
  return Decoded::kFine;
}

std::size_t encode(const Stats& stats, MessageBuffer& buffer) {
  dancelcm::stats_t m{};
  m.time_us = to_us(stats.time);
  m.clock_id = static_cast<std::int64_t>(stats.clock_id);
  m.uptime_us = stats.uptime.count_us();
  m.received = stats.received;
  m.forwarded = stats.forwarded;
  m.superseded = stats.superseded;
  m.dropped_late = stats.dropped_late;
  m.dropped_invalid = stats.dropped_invalid;
  m.dropped_unrouted = stats.dropped_unrouted;
  m.dropped_overflow = stats.dropped_overflow;
  m.lost = stats.lost;
  m.bytes_in = stats.bytes_in;
  m.bytes_out = stats.bytes_out;
  m.datagrams_in = stats.datagrams_in;
  m.datagrams_out = stats.datagrams_out;
  m.rejected_datagrams = stats.rejected_datagrams;
  m.guests = stats.guests;
  m.sessions = stats.sessions;
  m.reconnects = stats.reconnects;
  m.round_trip_us = stats.round_trip.count_us();
  m.clock_offset_us = stats.clock_offset.count_us();
  m.lateness_p99_us = stats.lateness_p99.count_us();
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Stats& stats) {
  dancelcm::stats_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  for (const std::int64_t t :
       {m.time_us, m.uptime_us, m.round_trip_us, m.clock_offset_us, m.lateness_p99_us})
    if (!is_time(t)) return Decoded::kInvalid;
  stats.time = from_us(m.time_us);
  stats.clock_id = static_cast<std::uint64_t>(m.clock_id);
  stats.uptime = Duration::us(m.uptime_us);
  stats.received = m.received;
  stats.forwarded = m.forwarded;
  stats.superseded = m.superseded;
  stats.dropped_late = m.dropped_late;
  stats.dropped_invalid = m.dropped_invalid;
  stats.dropped_unrouted = m.dropped_unrouted;
  stats.dropped_overflow = m.dropped_overflow;
  stats.lost = m.lost;
  stats.bytes_in = m.bytes_in;
  stats.bytes_out = m.bytes_out;
  stats.datagrams_in = m.datagrams_in;
  stats.datagrams_out = m.datagrams_out;
  stats.rejected_datagrams = m.rejected_datagrams;
  stats.guests = m.guests;
  stats.sessions = m.sessions;
  stats.reconnects = m.reconnects;
  stats.round_trip = Duration::us(m.round_trip_us);
  stats.clock_offset = Duration::us(m.clock_offset_us);
  stats.lateness_p99 = Duration::us(m.lateness_p99_us);
  return Decoded::kFine;
}

std::size_t encode(const StageTime& stage_time, MessageBuffer& buffer) {
  dancelcm::stage_time_t m{};
  m.clock_id = static_cast<std::int64_t>(stage_time.clock_id);
  m.sequence = static_cast<std::int32_t>(stage_time.sequence);
  m.capture_time_us = to_us(stage_time.capture_time);
  for (std::size_t i = 0; i < kHopCount; ++i) m.hop_time_us[i] = to_us(stage_time.hops[i]);
  m.heard_time_us = to_us(stage_time.heard_time);
  m.swap_time_us = to_us(stage_time.swap_time);
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, StageTime& stage_time) {
  dancelcm::stage_time_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  for (const std::int64_t t : {m.capture_time_us, m.heard_time_us, m.swap_time_us})
    if (!is_time(t)) return Decoded::kInvalid;
  for (std::size_t i = 0; i < kHopCount; ++i) {
    if (!is_time(m.hop_time_us[i])) return Decoded::kInvalid;
    stage_time.hops[i] = from_us(m.hop_time_us[i]);
  }
  stage_time.clock_id = static_cast<std::uint64_t>(m.clock_id);
  stage_time.sequence = static_cast<std::uint32_t>(m.sequence);
  stage_time.capture_time = from_us(m.capture_time_us);
  stage_time.heard_time = from_us(m.heard_time_us);
  stage_time.swap_time = from_us(m.swap_time_us);
  return Decoded::kFine;
}

}  // namespace dance
