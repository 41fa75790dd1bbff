// Interface of pose codecs: Pose ⇄ the payload of one record. One encoder for each guest that is
// sent, one decoder for each guest that is received; both may keep reference frames, so the tunnel
// notifies them of acknowledgements, requests and restarts. The codec is agreed in the tunnel's
// hello by its name.
//
// Units/frames: as in core/pose/pose.h. The payload holds rotations, hips, presence, confidence and
//               musical time; sequence, capture time and hops travel in the record around it.
// Ownership:    encoders and decoders are made once per guest; encode() and decode() never
//               allocate.
// Threads:      none inside; one owner.
// Failure:      encode() of an invalid pose gives 0 bytes; decode() says why there is no pose. Its
//               result is_valid().
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
  kPlain = 1,    // every frame intra, core/codec/plain_codec.h
  kLattice = 2,  // predicted and range-coded, core/codec/lattice/lattice_codec.h
};

// Name of a codec; equal at two ends that exchange poses.
struct CodecName {
  CodecId id = CodecId::kNone;
  std::uint32_t model =
      0;  // first 32 bits of the trained model's hash; 0 = none, or the generic one
  bool operator==(const CodecName&) const = default;
};

// Longest payload of any codec.
constexpr std::size_t kMaxPosePayload = 512;

// Which earlier frames a frame may refer to.
enum class References : std::uint8_t {
  kPrevious,       // the previous frame: fewest bytes; after a loss nothing decodes until an intra
                   // frame or an acknowledged reference
  kPreviousTwice,  // the same, and each payload contains the previous frame: survives single losses
  kAcknowledged,   // frames that every receiver has: whatever arrives decodes
};

// Name in reports.
const char* name_of(References references);

enum class DecodeResult : std::uint8_t {
  kPose,
  kMalformed,         // not made by an encoder
  kReferenceMissing,  // a reference frame is missing: request an intra frame
  kSkeletonMissing,   // made with proportions that set_skeleton() has not set yet
};

class PoseEncoder {
 public:
  virtual ~PoseEncoder() = default;
  virtual CodecName name() const = 0;
  // Returns the bytes written, or 0 where the pose is not valid or does not fit.
  virtual std::size_t encode(const Pose& pose, std::span<std::uint8_t> payload) = 0;
  // Every receiver has decoded the frame of this sequence: it may be a reference. In any order.
  virtual void acknowledged(std::uint32_t /*sequence*/) {}
  // A receiver has no reference: the next frame is intra, and earlier acknowledgements are void.
  virtual void request_intra() {}
  // The next frame is intra; acknowledgements stay valid.
  virtual void request_refresh() {}
  // The next frame is a base frame: it refers only to frames of base_acknowledged().
  virtual void request_base() {}
  // Every receiver, also those with a reduced interest, has decoded the frame of this sequence.
  virtual void base_acknowledged(std::uint32_t /*sequence*/) {}
  // Whether the frame encoded last is intra.
  virtual bool is_intra() const { return true; }
  // A new stream begins: sequences start anew.
  virtual void restart() {}
  virtual void set_references(References) {}
  // The largest error in any joint that is allowed, in metres.
  virtual void set_quality(double /*error_m*/) {}
  // The dancer's proportions as decode_skeleton() gives them at the other end.
  virtual void set_skeleton(const Skeleton&) {}
};

class PoseDecoder {
 public:
  virtual ~PoseDecoder() = default;
  virtual CodecName name() const = 0;
  // Fills what the payload holds; `sequence` is the record's. Anything but kPose leaves `pose`
  // unspecified.
  virtual DecodeResult decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                              Pose& pose) = 0;
  // A new stream of the guest begins: earlier frames are no longer references.
  virtual void restart() {}
  virtual void set_skeleton(const Skeleton&) {}
};

// The codecs of this build, the preferred one first.
std::span<const CodecName> known_codecs();
bool is_known(CodecName name);
// nullptr for an unknown codec.
std::unique_ptr<PoseEncoder> make_pose_encoder(CodecName name);
std::unique_ptr<PoseDecoder> make_pose_decoder(CodecName name);

}  // namespace dance
