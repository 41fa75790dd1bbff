// What both ends of the lattice codec keep of a decoded frame, and how a frame's header is written:
// its references, its level, and the parts of a pose beside the body.
//
// Units/frames: as docs/codec.md says; musical time in 1/1024 beat, confidence in 1/63.
// Ownership:    plain values; a ring holds the last 64 frames by sequence, some 100 KB, and never
//               allocates.
// Threads:      none inside.
// Failure:      read functions are false for what no encoder writes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/codec/coding/range_coder.h"
#include "core/codec/lattice/body_lattice.h"
#include "core/codec/lattice/pose_model.h"
#include "core/pose/pose.h"

namespace dance {

// A pose without its body.
struct PoseExtras {
  std::uint32_t presence = kAllBones;
  std::uint8_t confidence = 63;
  bool has_music = false;
  std::int64_t music = 0;
  bool operator==(const PoseExtras&) const = default;
};
PoseExtras extras_of(const Pose& pose);
void put_extras(const PoseExtras& extras, Pose& pose);

struct CodedFrame {
  bool in_use = false;
  bool is_acknowledged = false;
  bool is_base_acknowledged = false;
  bool is_chained = false;  // decodes with the last intra frame and all since
  std::uint32_t sequence = 0;
  std::uint8_t level = 3;
  bool is_slow = false;
  PoseExtras extras;
  ReferenceBody body;
};

class FrameRing {
 public:
  static constexpr std::uint32_t kFrames = 64;
  static constexpr std::uint32_t kOldest = kFrames - 1;

  CodedFrame* find(std::uint32_t sequence) {
    CodedFrame& frame = frames_[sequence % kFrames];
    return frame.in_use && frame.sequence == sequence ? &frame : nullptr;
  }
  // The slot for a new frame; its old content is overwritten.
  CodedFrame& make(std::uint32_t sequence) {
    CodedFrame& frame = frames_[sequence % kFrames];
    frame.in_use = true;
    frame.is_acknowledged = frame.is_base_acknowledged = frame.is_chained = false;
    frame.sequence = sequence;
    return frame;
  }
  void clear() {
    for (CodedFrame& frame : frames_) frame.in_use = false;
  }
  void break_chain() {
    for (CodedFrame& frame : frames_) frame.is_chained = false;
  }
  void forget_acknowledged() {
    for (CodedFrame& frame : frames_) frame.is_acknowledged = frame.is_base_acknowledged = false;
  }

 private:
  std::array<CodedFrame, kFrames> frames_;
};

enum class FrameKind : std::uint8_t {
  kDelta,  // refers to earlier frames
  kIntra,  // refers to none
  kTwice,  // contains the previous frame as well
};

struct FrameHead {
  FrameKind kind = FrameKind::kDelta;
  std::uint8_t age = 0;  // delta: of the newest reference, 1 to 63
  std::uint8_t run = 0;  // delta: 1, 2 or 4
  std::uint8_t level = 3;
  bool is_slow = false;           // intra
  std::uint8_t skeleton_tag = 0;  // intra
  std::uint8_t twice_bytes = 0;   // twice
};

constexpr std::size_t kTwiceHeadBytes = 2;

void write_head(const FrameHead& head, std::uint8_t base_level, RangeEncoder& out);
// The kind first; then the rest of an intra or delta head; then, with the base frame known, a
// delta's level.
void read_kind(RangeDecoder& in, FrameHead& head);
bool read_head(RangeDecoder& in, FrameHead& head);
bool read_level(RangeDecoder& in, std::uint8_t base_level, FrameHead& head);

// `base` is the newest reference, `before` the next; nullptr where there is none.
void write_extras(const PoseExtras& extras, const CodedFrame* base, const CodedFrame* before,
                  unsigned age, const DistributionTable& table, RangeEncoder& out);
bool read_extras(RangeDecoder& in, const CodedFrame* base, const CodedFrame* before, unsigned age,
                 const DistributionTable& table, PoseExtras& extras);

// One frame in 32 carries this checksum of its body, so that diverged ends notice: spread evenly
// (Fibonacci hashing), whatever the step of sequences.
constexpr bool has_check(std::uint32_t sequence) { return sequence * 2654435761u < 1u << 27; }
std::uint16_t check_of(const BodyLattice& lattice, std::size_t level, std::uint8_t skeleton_tag,
                       const ReferenceBody& body);

// Identifies the skeleton in an intra frame.
std::uint8_t tag_of(const Skeleton& skeleton);

}  // namespace dance
