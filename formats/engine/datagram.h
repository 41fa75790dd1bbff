// The datagrams of the way back: what an engine's own tracker sees of a dancer, to the house on the
// same machine. One for each pose, and beside it for hands and proportions.
//
// Units/frames: as in core/pose; times in ns of CLOCK_MONOTONIC. Numbers are this machine's: a
//               datagram never leaves it.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      decode() is the one place where a datagram is checked: size, version and every
//               number. Its Fault says what is wrong.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <variant>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance::engine {

// "engine-NAME" in the folder of this user's sockets.
constexpr const char* kSocketPrefix = "engine-";

struct DatagramHead {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t kind;
  std::uint64_t session;  // another number: another run of an engine
};

struct PoseDatagram {
  DatagramHead head;
  float rotation_xyzw[kBoneCount][4];
  float hips_m[3];
  std::uint32_t presence;
  float confidence;
  std::uint32_t reserved;
  std::int64_t capture_ns;
};
static_assert(sizeof(PoseDatagram) == 408);

struct HandsDatagram {
  DatagramHead head;
  float rotation_xyzw[kFingerBoneCount][4];
  std::uint32_t presence;
  std::uint32_t reserved;
  std::int64_t capture_ns;
};
static_assert(sizeof(HandsDatagram) == 520);

struct SkeletonDatagram {
  DatagramHead head;
  float offset_m[kBoneCount][3];
  float tip_m[kTipCount][3];
  std::uint32_t reserved;
};
static_assert(sizeof(SkeletonDatagram) == 352);

constexpr std::size_t kMostDatagram_bytes = sizeof(HandsDatagram);
using DatagramBuffer = std::array<std::uint8_t, kMostDatagram_bytes>;

// Of a pose rotations, hips, presence, confidence and capture time are sent, of hands the same.
// The bytes lie in the buffer.
std::span<const std::uint8_t> encode(std::uint64_t session, const Pose& pose,
                                     DatagramBuffer& buffer);
std::span<const std::uint8_t> encode(std::uint64_t session, const Hands& hands,
                                     DatagramBuffer& buffer);
std::span<const std::uint8_t> encode(std::uint64_t session, const Skeleton& skeleton,
                                     DatagramBuffer& buffer);

enum class Fault : std::uint8_t { kForeign, kOtherVersion, kWrongSize, kInvalid };

struct Received {
  std::uint64_t session = 0;
  std::variant<Fault, Pose, Hands, Skeleton> what = Fault::kForeign;
};

// Poses and hands are normalised.
Received decode(std::span<const std::uint8_t> bytes);

}  // namespace dance::engine
