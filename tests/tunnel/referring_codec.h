// A codec for tests: the plain one, with a reference in front of each payload that the decoder must
// have. Tells what it was told.
//
// Ownership: as the seam says; logs outlive the codecs.
// Threads:   none inside.
// Failure:   as the seam says.
#pragma once

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/base/sequence.h"
#include "core/codec/plain_codec.h"
#include "tunnel/link/core/link_options.h"

namespace dance {

constexpr CodecName kReferring{static_cast<CodecId>(200), 0x0badcafe};

// What happened to all encoders and decoders of one house.
struct ReferringLog {
  std::vector<std::uint32_t> acknowledged;
  int intra_frames_wanted = 0;
  int intra_frames_encoded = 0;
  int encoder_restarts = 0;
  int decoder_restarts = 0;
  bool needs_skeleton = false;
  std::vector<References> references;
};

inline std::uint8_t check_of(const Skeleton& skeleton) {
  std::array<std::uint8_t, kSkeletonPayload> payload;
  const std::size_t size = encode_skeleton(skeleton, payload);
  // Bit for bit the same, or it is another.
  Skeleton rounded;
  const bool is_rounded =
      decode_skeleton({payload.data(), size}, rounded) && rounded.offset_m == skeleton.offset_m;
  std::uint8_t sum = is_rounded ? 1 : 128;
  for (std::size_t i = 4; i < size; ++i) sum = static_cast<std::uint8_t>(sum * 31 + payload[i]);
  return sum == 0 ? 1 : sum;
}

class ReferringEncoder final : public PoseEncoder {
 public:
  explicit ReferringEncoder(ReferringLog& log) : log_(log) {}
  CodecName name() const override { return kReferring; }
  std::size_t encode(const Pose& pose, std::span<std::uint8_t> payload) override {
    const std::size_t size = plain_.encode(pose, payload.subspan(kHead));
    if (size == 0) return 0;
    const bool is_base = std::exchange(is_base_, false);
    const bool is_by_ack = references_ == References::kAcknowledged;
    const bool has_reference = !wants_key_ && (is_base     ? has_base_acked_
                                               : is_by_ack ? has_acked_
                                                           : has_previous_);
    is_still_ = !has_reference;
    if (!has_reference) ++log_.intra_frames_encoded;
    wants_key_ = false;
    const std::uint32_t reference = !has_reference ? previous_
                                    : is_base      ? newest_base_acked_
                                    : is_by_ack    ? newest_acked_
                                                   : previous_;
    ByteWriter out(payload);
    out.u8(has_reference ? (references_ == References::kPreviousTwice && !is_base ? 2 : 1) : 0);
    out.u32(reference);
    out.u32(before_);
    out.u8(check_);
    before_ = has_previous_ ? previous_ : pose.sequence;
    previous_ = pose.sequence;
    has_previous_ = true;
    return size + kHead;
  }
  void acknowledged(std::uint32_t sequence) override {
    log_.acknowledged.push_back(sequence);
    // What left before the last request says nothing of who asked.
    if (has_void_ && !is_newer_sequence(sequence, void_until_)) return;
    if (!has_acked_ || is_newer_sequence(sequence, newest_acked_)) newest_acked_ = sequence;
    has_acked_ = true;
  }
  void base_acknowledged(std::uint32_t sequence) override {
    if (has_void_ && !is_newer_sequence(sequence, void_until_)) return;
    if (!has_base_acked_ || is_newer_sequence(sequence, newest_base_acked_))
      newest_base_acked_ = sequence;
    has_base_acked_ = true;
  }
  void request_refresh() override { wants_key_ = true; }
  void request_base() override { is_base_ = true; }
  bool is_intra() const override { return is_still_; }
  void request_intra() override {
    ++log_.intra_frames_wanted;
    wants_key_ = true;
    has_acked_ = has_base_acked_ = false;
    has_void_ = has_previous_;
    void_until_ = previous_;
  }
  void restart() override {
    ++log_.encoder_restarts;
    has_previous_ = has_acked_ = has_base_acked_ = has_void_ = false;
  }
  void set_references(References references) override {
    references_ = references;
    log_.references.push_back(references);
  }
  void set_skeleton(const Skeleton& skeleton) override { check_ = check_of(skeleton); }

  static constexpr std::size_t kHead = 10;

 private:
  ReferringLog& log_;
  PlainEncoder plain_;
  References references_ = References::kPrevious;
  bool has_acked_ = false;
  std::uint32_t newest_acked_ = 0;
  bool has_base_acked_ = false;
  std::uint32_t newest_base_acked_ = 0;
  bool is_base_ = false, is_still_ = false;
  bool has_void_ = false;
  std::uint32_t void_until_ = 0;
  bool wants_key_ = false, has_previous_ = false;
  std::uint32_t previous_ = 0, before_ = 0;
  std::uint8_t check_ = 0;
};

class ReferringDecoder final : public PoseDecoder {
 public:
  explicit ReferringDecoder(ReferringLog& log) : log_(log) {}
  CodecName name() const override { return kReferring; }
  DecodeResult decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                      Pose& pose) override {
    ByteReader in(payload);
    const int references = in.u8();
    const std::uint32_t reference = in.u32(), before = in.u32();
    const std::uint8_t check = in.u8();
    if (!in.ok() || references > 2) return DecodeResult::kMalformed;
    if (log_.needs_skeleton && check_ != check) return DecodeResult::kSkeletonMissing;
    if (references != 0 && !has(reference) && !(references == 2 && has(before)))
      return DecodeResult::kReferenceMissing;
    if (plain_.decode(sequence, payload.subspan(ReferringEncoder::kHead), pose) !=
        DecodeResult::kPose)
      return DecodeResult::kMalformed;
    if (references == 2) known_.push_back(reference);
    known_.push_back(sequence);
    while (known_.size() > 128) known_.pop_front();
    return DecodeResult::kPose;
  }
  void restart() override {
    ++log_.decoder_restarts;
    known_.clear();
  }
  void set_skeleton(const Skeleton& skeleton) override { check_ = check_of(skeleton); }

 private:
  bool has(std::uint32_t sequence) const {
    return std::find(known_.begin(), known_.end(), sequence) != known_.end();
  }
  ReferringLog& log_;
  PlainDecoder plain_;
  std::deque<std::uint32_t> known_;
  std::uint8_t check_ = 0;
};

// A link with this codec writes to `log`.
inline void use_referring_codec(LinkOptions& options, ReferringLog& log) {
  options.codecs.clear();
  if (!options.codecs.try_push(kReferring)) std::abort();
  options.make_encoder = [&log](CodecName) { return std::make_unique<ReferringEncoder>(log); };
  options.make_decoder = [&log](CodecName) { return std::make_unique<ReferringDecoder>(log); };
}

}  // namespace dance
