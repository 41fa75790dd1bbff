// Segment: the layout of the memory through which a house shows its stage to the engines of this
// machine. Written by SegmentWriter, read by SegmentReader, and by nobody else.
//
// Units/frames: poses as in core/pose; times in ns of CLOCK_MONOTONIC, which all processes of a
//               machine share.
// Ownership:    plain values and atomic words at fixed places; the sizes below are the format.
// Threads:      one writer; any number of readers in any processes.
// Failure:      is_valid() is the one place that decides whether what was copied out of the memory
//               may be used. Another version has another kVersion, and is not read.
#pragma once

#include "core/base/guest_id.h"
#include "core/pose/bone.h"
#include "formats/engine/number_ring.h"

namespace dance::engine {

constexpr std::uint64_t kMagic = 0x4547415453434e44;  // "DNCSTAGE"
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kGuestSlots = 64;
constexpr std::size_t kPoseRing = 32;  // a third of a second at 90 Hz
// Of the ring, without the entry that is written next.
constexpr std::size_t kMostPoses = kPoseRing - 1;

struct StoredPose {
  float rotation_xyzw[kBoneCount][4];
  float hips_m[3];
  std::uint32_t presence;
  float confidence;
  std::uint32_t sequence;
  std::int64_t capture_ns;
  std::int64_t staged_ns;
  std::int64_t lag_ns;  // how much later than its capture this dancer's dance is shown; smoothed
  double music_beats;   // NaN without music
};
static_assert(sizeof(StoredPose) == 408);

struct StoredHands {
  float rotation_xyzw[kFingerBoneCount][4];
  std::uint32_t presence;
  std::uint32_t reserved;
  std::int64_t capture_ns;
};
static_assert(sizeof(StoredHands) == 496);

struct StoredSkeleton {
  float offset_m[kBoneCount][3];
  float tip_m[kTipCount][3];
  std::uint32_t version;
};
static_assert(sizeof(StoredSkeleton) == 328);

struct StoredBeat {
  std::int64_t time_ns;
  std::int64_t beat_time_ns;
  double beat;
  double tempo_bpm;
  std::int32_t beats_per_bar;
  float confidence;
  std::uint32_t playing;
  std::uint32_t reserved;
};
static_assert(sizeof(StoredBeat) == 48);

constexpr std::uint32_t kAllFingers = (1u << kFingerBoneCount) - 1;
constexpr std::size_t kIdBytes = 32;  // with a zero at the end

struct alignas(64) GuestSlot {
  // Grows when a dancer takes the slot and when it leaves; odd while one is there. All else belongs
  // to the dancer of that generation.
  std::atomic<std::uint32_t> generation;
  std::atomic<std::uint32_t> reserved;
  std::atomic<std::int64_t> newest_staged_ns;
  Word id[kIdBytes / sizeof(Word)];
  NumberRing<StoredPose, kPoseRing> poses;
  NumberRing<StoredSkeleton, 2> skeletons;
  NumberRing<StoredHands, 4> hands;
};

enum class SegmentState : std::uint32_t { kOpening = 0, kOpen = 1, kClosed = 2 };

struct alignas(64) SegmentHeader {
  Word magic;  // stored last: 0 while the memory is being made
  std::atomic<std::uint32_t> version;
  std::atomic<std::uint32_t> guest_slots;
  Word segment_bytes;
  Word epoch;  // another number: another run of the writer
  std::atomic<std::uint32_t> state;
  std::atomic<std::uint32_t> reserved;
  std::atomic<std::int64_t> heartbeat_ns;  // when the writer last was there
};

struct Segment {
  SegmentHeader header;
  NumberRing<StoredBeat, 4> beats;
  GuestSlot guests[kGuestSlots];
};
static_assert(std::is_standard_layout_v<Segment>);

// A writer that was not there for this long is gone, or hangs.
constexpr std::int64_t kHeartbeatStays_ns = 3'000'000'000;

// Times that can be computed with.
constexpr std::int64_t kLastTime_ns = std::int64_t{1} << 61;
constexpr bool is_time(std::int64_t ns) { return ns > 0 && ns < kLastTime_ns; }
// A stage may show a dancer this long after the capture.
constexpr std::int64_t kLongestLag_ns = 120'000'000'000;

bool is_valid(const StoredPose& pose);
bool is_valid(const StoredHands& hands);
bool is_valid(const StoredSkeleton& skeleton);
bool is_valid(const StoredBeat& beat);

}  // namespace dance::engine
