// The seam of the pose codec: Pose ⇄ the payload of one record. One encoder for each guest that is
// sent, one decoder for each guest that is heard; both may keep state (references to earlier
// frames), so the tunnel tells them what was acknowledged, asked for and begun anew. Which codec is
// spoken is agreed at the tunnel's hello by its name.
//
// Units/frames: as in core/pose/pose.h. The payload holds rotations, hips, presence, confidence and
//               musical time; sequence, capture time and hops travel in the record around it.
// Ownership:    encoders and decoders are made once per guest; encode() and decode() never
//               allocate.
// Threads:      none inside; one owner.
// Failure:      encode() of an invalid pose gives 0 bytes; decode() says why there is no pose. What
//               it lets through is_valid().
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

enum class CodecId : std::uint8_t {
  kNone = 0,
  kPlain = 1,    // each bone for itself, core/codec/plain_codec.h
  kLattice = 2,  // predicted and range-coded, core/codec/lattice_codec.h
};

// What two ends must have in common to understand each other.
struct CodecName {
  CodecId id = CodecId::kNone;
  std::uint32_t model =
      0;  // first 32 bits of the trained model's hash; 0 = none, or the generic one
  bool operator==(const CodecName&) const = default;
};

// No payload is longer, whatever the codec.
constexpr std::size_t kMaxPosePayload = 512;

// Which earlier frames a frame may refer to.
enum class References : std::uint8_t {
  kPrevious,  // the one sent before: fewest bytes; a lost one is missed until the next key frame
              // or acknowledged reference
  kPreviousTwice,  // the same, and each payload brings the previous frame again: one loss in a row
                   // does no harm
  kAcknowledged,   // only frames that every receiver has: whatever arrives decodes
};

// As reports say it.
const char* name_of(References references);

enum class DecodeResult : std::uint8_t {
  kPose,
  kMalformed,         // not something that our encoder makes
  kReferenceMissing,  // refers to a frame that has not come: ask for a key frame
  kSkeletonMissing,   // made with proportions that set_skeleton() has not told yet
};

class PoseEncoder {
 public:
  virtual ~PoseEncoder() = default;
  virtual CodecName name() const = 0;
  // Bytes written into payload, or 0 where the pose is not valid or does not fit.
  virtual std::size_t encode(const Pose& pose, std::span<std::uint8_t> payload) = 0;
  // Every receiver has decoded the frame of this sequence: it may be referred to. In any order.
  virtual void acknowledged(std::uint32_t /*sequence*/) {}
  // Somebody has nothing to refer to: the next frame needs no other, and what was acknowledged
  // before counts no more.
  virtual void key_frame_wanted() {}
  // The next frame needs no other; what was acknowledged counts on.
  virtual void still_wanted() {}
  // The next frame is for those too who get only some frames: it refers to nothing but what
  // base_acknowledged() told.
  virtual void base_wanted() {}
  // Every receiver, and those who get only some frames, have decoded the frame of this sequence.
  virtual void base_acknowledged(std::uint32_t /*sequence*/) {}
  // Whether the frame that was encoded last needs no other. Not so for codecs that refer.
  virtual bool needs_no_other() const { return true; }
  // A new stream begins: sequences start anew.
  virtual void restart() {}
  virtual void set_references(References) {}
  // The largest error in any joint that is allowed, in metres.
  virtual void set_quality(double /*error_m*/) {}
  // The dancer's proportions, which say how much an angle moves: as decode_skeleton() gives them at
  // the other end.
  virtual void set_skeleton(const Skeleton&) {}
};

class PoseDecoder {
 public:
  virtual ~PoseDecoder() = default;
  virtual CodecName name() const = 0;
  // Fills what the payload holds; `sequence` is the record's. Anything but kPose leaves pose as it
  // may be: do not use it.
  virtual DecodeResult decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                              Pose& pose) = 0;
  // A new stream of the guest begins: earlier frames are no references any more.
  virtual void restart() {}
  virtual void set_skeleton(const Skeleton&) {}
};

// The codecs of this build, the preferred one first.
std::span<const CodecName> known_codecs();
bool is_known(CodecName name);
// nullptr for a codec that is not known here.
std::unique_ptr<PoseEncoder> make_pose_encoder(CodecName name);
std::unique_ptr<PoseDecoder> make_pose_decoder(CodecName name);

}  // namespace dance
