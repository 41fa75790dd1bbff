#include <cmath>

#include "core/codec/lattice_codec.h"

namespace dance {
namespace {

// No encoder goes further: a swing is within half a turn, a stage within a kilometre.
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
                                         std::span<const BodyState* const> references) {
  BodyPredictor predictor(lattice_, *model_, head.level, head.is_slow, head.age, references);
  const BellShape& bell = references.empty() ? model_->intra_bell : model_->bell;
  BodyState& body = fresh_.body;
  for (std::size_t c = 0; c < kCoordinateCount; ++c) {
    if (c >= 3 && c % 3 == 0) lattice_.seat_bone((c - 3) / 3, body);
    const std::int32_t n = SymbolLaw(bell, predictor.predict(c, body)).decode(in);
    predictor.decoded(c, n);
    const std::int32_t turn = lattice_.turn(c, head.level);
    body.x[c] = lattice_.step(c, head.level) * wrapped(n, turn);
    const double most = c < 3 ? kFarthest_m : kLargestSwing_rad;
    if (std::abs(body.x[c]) > most) return DecodeResult::kMalformed;
    if (c >= 3 && c % 3 == 2) lattice_.place_bone((c - 3) / 3, body);
  }
  if (!references.empty() && has_check(sequence) &&
      in.decode_bits(16) != check_of(lattice_, head.level, skeleton_tag_, body))
    return DecodeResult::kReferenceMissing;  // what we hold of this sequence is not what they sent
  return in.is_exhausted() ? DecodeResult::kPose : DecodeResult::kMalformed;
}

DecodeResult LatticeDecoder::decode_frame(std::uint32_t sequence,
                                          std::span<const std::uint8_t> payload) {
  if (payload.size() == 1 && payload[0] == 0) payload = {};
  RangeDecoder in(payload);
  FrameHead head;
  read_kind(in, head);
  if (head.kind == FrameKind::kTwice || !read_head(in, head)) return DecodeResult::kMalformed;
  std::array<const CodedFrame*, 4> frames{};
  std::array<const BodyState*, 4> bodies{};
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
  if (!read_extras(in, frames[0], frames[1], head.age, model_->bell, fresh_.extras))
    return DecodeResult::kMalformed;
  const DecodeResult result = decode_body(in, head, sequence, {bodies.data(), head.run});
  if (result != DecodeResult::kPose) return result;
  CodedFrame& frame = ring_.make(sequence);
  frame.level = head.level;
  frame.is_slow = head.is_slow;
  frame.extras = fresh_.extras;
  frame.body = fresh_.body;
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
    // Only where it was missed; what it refers to may be missing too, which the frame itself tells.
    if (ring_.find(sequence - next.age) == nullptr &&
        decode_frame(sequence - next.age, before) == DecodeResult::kMalformed)
      return DecodeResult::kMalformed;
  }
  const DecodeResult result = decode_frame(sequence, payload);
  if (result != DecodeResult::kPose) return result;
  const CodedFrame& frame = *ring_.find(sequence);
  const exact::Vec& place = frame.body.joint[0];
  pose.p_WH_m = {static_cast<float>(place.x), static_cast<float>(place.y),
                 static_cast<float>(place.z)};
  for (std::size_t b = 0; b < kBoneCount; ++b)
    pose.R_PB[b] = to_float(lattice_.local(b, frame.body));
  put_extras(frame.extras, pose);
  return is_valid(pose) ? DecodeResult::kPose : DecodeResult::kMalformed;
}

}  // namespace dance
