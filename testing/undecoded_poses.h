// UndecodedPoses: a decoder that takes every payload for a pose and does not look into it. For
// simulated guests who only make a crowd: what the others of a real crowd decode, they decode on
// machines of their own.
//
// Units/frames: the pose's sequence and times are the record's; its body is what it was before.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none: a damaged payload is a pose too.
#pragma once

#include "core/codec/pose_codec.h"

namespace dance {

class UndecodedPoses final : public PoseDecoder {
 public:
  explicit UndecodedPoses(CodecName name) : name_(name) {}
  CodecName name() const override { return name_; }
  DecodeResult decode(std::uint32_t, std::span<const std::uint8_t>, Pose&) override {
    return DecodeResult::kPose;
  }

 private:
  CodecName name_;
};

}  // namespace dance
