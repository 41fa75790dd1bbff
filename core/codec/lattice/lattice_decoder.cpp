#include <cmath>

#include "core/codec/lattice/lattice_codec.h"

namespace dance {
namespace {

// Bounds of what encoders produce: a swing is within half a turn, a stage within a kilometre.
constexpr double kLargestSwing_rad = 3.5;
constexpr double kFarthest_m = 2.0 * static_cast<double>(kMaxStageDistance_m);

Eigen::Quaternionf to_float(const exact::Quat& q) {
  const exact::Quat u = exact::normalized(q);
  return {static_cast<float>(u.w), static_cast<float>(u.x), static_cast<float>(u.y),
          static_cast<float>(u.z)};
}

}  // namespace

LatticeDecoder::LatticeDecoder(std::shared_ptr<const PoseModel> model)
    : model_(std::move(model)),
      lattice_(average_skeleton(), model_->rest),
      skeleton_tag_(tag_of(average_skeleton())) {}

void LatticeDecoder::set_skeleton(const Skeleton& skeleton) {
  const std::uint8_t tag = tag_of(skeleton);
  lattice_ = BodyLattice(skeleton, model_->rest);
  skeleton_tag_ = tag;
  ring_.clear();
}

DecodeResult LatticeDecoder::decode_body(RangeDecoder& in, const FrameHead& head,
                                         std::uint32_t sequence,
                                         std::span<const ReferenceBody* const> references,
                                         Pose& pose) {
  BodyPredictor predictor(lattice_, *model_, head.level, head.is_slow, head.age, references);
  const DistributionTable& table = references.empty() ? model_->intra_table : model_->table;
  const LatticeSteps& steps = lattice_.steps(head.level);
  LatticeBodyState& body = fresh_body_;
  // Inline, so that state passed from one coordinate to the next stays in registers.
  const auto decode_axis = [&](std::size_t first, std::size_t axis) __attribute__((always_inline)) {
    const std::int32_t n =
        SymbolDistribution(table, predictor.predict_axis(first, axis, body)).decode(in);
    predictor.decoded(first + axis, n);
    return n;
  };
  // The place, then bone after bone.
  for (std::size_t c = 0; c < kCoordinateCount; c += 3) {
    const std::size_t bone = c / 3 - 1;
    if (c > 0) lattice_.seat_bone(bone, body);
    predictor.look_at(c, body);
    double* x = &body.x[c];
    x[0] = steps.step[c] * decode_axis(c, 0);
    x[1] = steps.step[c + 1] * decode_axis(c, 1);
    x[2] = steps.step[c + 2] * wrapped(decode_axis(c, 2), steps.turn[c + 2]);
    const double most = c == 0 ? kFarthest_m : kLargestSwing_rad;
    if (std::abs(x[0]) > most || std::abs(x[1]) > most || std::abs(x[2]) > most)
      return DecodeResult::kMalformed;
    if (c == 0) continue;
    pose.R_PB[bone] = to_float(lattice_.local(bone, lattice_.place_bone(bone, body)));
  }
  pose.p_WH_m = {static_cast<float>(body.x[0]), static_cast<float>(body.x[1]),
                 static_cast<float>(body.x[2])};
  if (!references.empty() && has_check(sequence) &&
      in.decode_bits(16) != check_of(lattice_, head.level, skeleton_tag_, body))
    return DecodeResult::kReferenceMissing;  // another frame of this sequence
  return in.is_exhausted() ? DecodeResult::kPose : DecodeResult::kMalformed;
}

DecodeResult LatticeDecoder::decode_frame(std::uint32_t sequence,
                                          std::span<const std::uint8_t> payload, Pose& pose) {
  if (payload.size() == 1 && payload[0] == 0) payload = {};
  RangeDecoder in(payload);
  FrameHead head;
  read_kind(in, head);
  if (head.kind == FrameKind::kTwice || !read_head(in, head)) return DecodeResult::kMalformed;
  std::array<const CodedFrame*, 4> frames{};
  std::array<const ReferenceBody*, 4> bodies{};
  if (head.kind == FrameKind::kIntra) {
    if (head.skeleton_tag != skeleton_tag_) return DecodeResult::kSkeletonMissing;
  } else {
    for (std::uint32_t i = 0; i < head.run; ++i) {
      if (head.age + i > FrameRing::kOldest) return DecodeResult::kMalformed;
      frames[i] = ring_.find(sequence - head.age - i);
      if (frames[i] == nullptr) return DecodeResult::kReferenceMissing;
      bodies[i] = &frames[i]->body;
    }
    head.is_slow = frames[0]->is_slow;
    if (!read_level(in, frames[0]->level, head)) return DecodeResult::kMalformed;
  }
  PoseExtras extras;
  if (!read_extras(in, frames[0], frames[1], head.age, model_->table, extras))
    return DecodeResult::kMalformed;
  const DecodeResult result = decode_body(in, head, sequence, {bodies.data(), head.run}, pose);
  if (result != DecodeResult::kPose) return result;
  CodedFrame& frame = ring_.make(sequence);
  frame.level = head.level;
  frame.is_slow = head.is_slow;
  frame.extras = extras;
  frame.body = fresh_body_;
  put_extras(extras, pose);
  return DecodeResult::kPose;
}

DecodeResult LatticeDecoder::decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                                    Pose& pose) {
  if (payload.empty()) return DecodeResult::kMalformed;
  RangeDecoder in(payload);
  FrameHead head;
  read_kind(in, head);
  if (head.kind == FrameKind::kTwice) {
    if (kTwiceHeadBytes + head.twice_bytes >= payload.size() || head.twice_bytes == 0)
      return DecodeResult::kMalformed;
    const auto before = payload.subspan(kTwiceHeadBytes, head.twice_bytes);
    payload = payload.subspan(kTwiceHeadBytes + head.twice_bytes);
    RangeDecoder main(payload.size() == 1 && payload[0] == 0 ? payload.first(0) : payload);
    FrameHead next;
    read_kind(main, next);
    if (next.kind != FrameKind::kDelta || !read_head(main, next)) return DecodeResult::kMalformed;
    // Only where it was lost; its own references may be missing too, which the frame itself
    // reports.
    if (ring_.find(sequence - next.age) == nullptr &&
        decode_frame(sequence - next.age, before, pose) == DecodeResult::kMalformed)
      return DecodeResult::kMalformed;
  }
  const DecodeResult result = decode_frame(sequence, payload, pose);
  if (result != DecodeResult::kPose) return result;
  return is_valid(pose) ? DecodeResult::kPose : DecodeResult::kMalformed;
}

}  // namespace dance
