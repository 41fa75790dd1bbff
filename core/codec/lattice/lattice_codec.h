// The lattice codec: a body in some twenty bytes with a bounded error of every joint. docs/codec.md
// describes it.
//
// Units/frames: errors in metres, at joints and tips in W; bones turn by at most what moves skin 3
//               cm from a joint as far, and by at most 4°.
// Ownership:    encoder and decoder keep the last 64 frames, some 100 KB each, and share the model;
//               made once per guest, they never allocate afterwards.
// Threads:      none inside; one owner.
// Failure:      as core/codec/pose_codec.h says. A pose that no lattice brings within the error
//               (none is known) is refused. Damaged bytes decode to another pose or are kMalformed;
//               every 32nd frame or so carries a checksum by which diverged ends notice.
#pragma once

#include <memory>

#include "core/codec/lattice/body_quantiser.h"
#include "core/codec/lattice/lattice_frame.h"
#include "core/codec/pose_codec.h"

namespace dance {

class LatticeEncoder final : public PoseEncoder {
 public:
  explicit LatticeEncoder(std::shared_ptr<const PoseModel> model);

  CodecName name() const override { return {CodecId::kLattice, model_->name}; }
  std::size_t encode(const Pose& pose, std::span<std::uint8_t> payload) override;
  void acknowledged(std::uint32_t sequence) override;
  void request_intra() override;
  void request_refresh() override { wants_key_ = true; }
  void request_base() override { is_base_ = true; }
  void base_acknowledged(std::uint32_t sequence) override;
  bool is_intra() const override { return is_still_; }
  void restart() override;
  void set_references(References references) override { policy_ = references; }
  void set_quality(double error_m) override;
  void set_skeleton(const Skeleton& skeleton) override;

  // Of the newest frame, for measurements.
  const CodedFrame* newest() { return has_last_ ? ring_.find(last_sequence_) : nullptr; }
  // For measurements: refers to the frame this many frames ago, whatever the policy; 0 = by the
  // policy.
  void refer_to_age(std::uint32_t age) { fixed_age_ = age; }

 private:
  struct Reference {
    std::uint32_t age = 0;  // 0: none
    std::size_t run = 0;
    std::array<const CodedFrame*, 4> frames{};
  };
  Reference choose_reference(std::uint32_t sequence);
  Reference reference_of_age(std::uint32_t sequence, std::uint32_t age);
  bool may_refer_to(const CodedFrame* frame) const;
  bool is_void(std::uint32_t sequence) const;
  std::size_t encode_frame(const Pose& pose, std::span<std::uint8_t> payload);
  BodyQuantiser::Still still_bones(const TrueBody& truth) const;
  // Chooses the lattice point; false where none is near enough.
  bool quantise(const TrueBody& truth, const BodyQuantiser::Still& still,
                const Reference& reference);
  std::size_t write(const Pose& pose, const Reference& reference, std::span<std::uint8_t> out);
  void watch_pace(MonoTime capture);

  std::shared_ptr<const PoseModel> model_;
  std::unique_ptr<FrameRing> frames_ = std::make_unique<FrameRing>();
  FrameRing& ring_ = *frames_;
  BodyLattice lattice_;
  BodyQuantiser quantiser_;
  std::uint8_t skeleton_tag_;
  References policy_ = References::kPrevious;
  double error_m_ = 0.001;
  std::size_t level_ = 3;  // of the error asked for
  std::size_t used_level_ = 3;
  std::uint32_t fixed_age_ = 0;
  bool wants_key_ = true;
  bool is_base_ = false;   // the frame that is being made
  bool is_still_ = false;  // the newest
  bool has_last_ = false;
  std::uint32_t last_sequence_ = 0;
  bool has_void_ = false;  // frames up to void_until_ are no references, even when acknowledged
  std::uint32_t void_until_ = 0;
  MonoTime last_capture_;
  Duration pace_ = Duration::us(16'667);
  bool is_slow_ = false;
  bool has_truth_ = false;
  std::array<exact::Quat, kBoneCount> last_local_{};  // true
  std::array<std::uint8_t, 255> last_payload_{};
  std::size_t last_size_ = 0;
};

class LatticeDecoder final : public PoseDecoder {
 public:
  explicit LatticeDecoder(std::shared_ptr<const PoseModel> model);

  CodecName name() const override { return {CodecId::kLattice, model_->name}; }
  DecodeResult decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                      Pose& pose) override;
  void restart() override { ring_.clear(); }
  void set_skeleton(const Skeleton& skeleton) override;

  // Of a decoded frame, for measurements; nullptr where it did not arrive.
  const CodedFrame* find(std::uint32_t sequence) { return ring_.find(sequence); }

 private:
  DecodeResult decode_frame(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                            Pose& pose);
  DecodeResult decode_body(RangeDecoder& in, const FrameHead& head, std::uint32_t sequence,
                           std::span<const ReferenceBody* const> references, Pose& pose);

  std::shared_ptr<const PoseModel> model_;
  std::unique_ptr<FrameRing> frames_ = std::make_unique<FrameRing>();
  FrameRing& ring_ = *frames_;
  BodyLattice lattice_;
  std::uint8_t skeleton_tag_;
  LatticeBodyState fresh_body_;  // until it is known to be whole
};

}  // namespace dance
