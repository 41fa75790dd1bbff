// Events of a bus as recorders hear them, for tests of packed logs: two dancers, with what else is
// on a bus beside them. Made of + − × ÷ and √ alone, so the same on every machine.
//
// Ownership: plain values.
// Threads:   none.
// Failure:   none.
#pragma once

#include <string>
#include <vector>

#include "core/bus/encode.h"
#include "formats/log/log_file.h"
#include "tests/core/codec/lattice_poses.h"

namespace dance {

using Bytes = std::vector<std::uint8_t>;

struct OwnEvent {
  std::int64_t number = 0;
  std::int64_t time_us = 0;
  std::string channel;
  Bytes data;

  OwnEvent() = default;
  OwnEvent(std::int64_t n, std::int64_t t, std::string c, Bytes d)
      : number(n), time_us(t), channel(std::move(c)), data(std::move(d)) {}
  explicit OwnEvent(const LogEvent& event)
      : OwnEvent(event.number, event.time_us, std::string(event.channel),
                 Bytes(event.data.begin(), event.data.end())) {}
  LogEvent event() const { return {number, time_us, channel, data}; }
  bool operator==(const OwnEvent&) const = default;
};
using OwnEvents = std::vector<OwnEvent>;

constexpr std::int64_t kEvening_us = 1'772'395'530'000'000;
constexpr std::int64_t kFrame_us = 16'667;

template <class Message>
Bytes bytes_of(const Message& message) {
  MessageBuffer buffer;
  const std::size_t size = encode(message, buffer);
  return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size)};
}

// Pose i of a dance, with stamps of so many hops.
inline RawPose recorded_pose(std::uint32_t i, Random& random, std::size_t hops = 1) {
  RawPose raw{dance_frame(i, random, 0.0), 0, {}};
  raw.pose.sequence = i;
  raw.pose.clock_id = 0x0123456789abcdef;
  raw.capture_time_us = 50'000'000 + i * kFrame_us + static_cast<std::int64_t>(random.below(5));
  for (std::size_t hop = 0; hop < hops; ++hop)
    raw.hop_time_us[hop] =
        raw.capture_time_us + static_cast<std::int64_t>(40 * (hop + 1) + random.below(30));
  return raw;
}

// Hands i of that dance: fingers that curl, each at its own pace.
inline RawHands recorded_hands(std::uint32_t i) {
  RawHands raw{Hands(), 50'000'000 + i * kFrame_us};
  raw.hands.sequence = i;
  raw.hands.clock_id = 0x0123456789abcdef;
  raw.hands.presence = (1u << kFingerBoneCount) - 1;
  for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone) {
    const double pace = 1.0 + 0.3 * static_cast<double>(bone % 5);
    const double curl = 0.2 + 0.1 * exact::sin(pace * static_cast<double>(i) / 60.0);
    raw.hands.R_PB[bone] = turned(0.0, 0.01, bone < kFingerBoneCount / 2 ? -curl : curl);
  }
  return raw;
}

// So many frames of two dancers on four channels, and a skeleton now and then.
inline OwnEvents recorded_evening(std::uint32_t frames, std::uint64_t seed = 1) {
  OwnEvents events;
  Random random(seed);
  const auto add = [&](std::uint32_t frame, const char* channel, Bytes data) {
    const auto number = static_cast<std::int64_t>(events.size());
    events.emplace_back(number, kEvening_us + frame * kFrame_us + number % 7, channel,
                        std::move(data));
  };
  for (std::uint32_t i = 0; i < frames; ++i) {
    add(i, "POSE/capture/alice", bytes_of(recorded_pose(i, random)));
    add(i, "POSE/guest/bob", bytes_of(recorded_pose(i + 30, random, 4)));
    add(i, "POSE/stage/bob", bytes_of(recorded_pose(i + 30, random, 6)));
    add(i, "HANDS/capture/alice", bytes_of(recorded_hands(i)));
    if (i % 60 == 0)
      add(i, "SKELETON/capture/alice", bytes_of(TimedSkeleton{average_skeleton(), {}, 7}));
  }
  return events;
}

}  // namespace dance
