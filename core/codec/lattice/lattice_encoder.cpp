#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/codec/lattice/lattice_codec.h"

namespace dance {
namespace {

// Frames further apart use the model trained at 30 a second.
constexpr Duration kSlowPace = Duration::us(22'500);
// No clock is a century off: differences stay within their type.
constexpr Duration kOldestCapture = Duration::s(3'000'000'000);
// A bone whose rotation differs by less from the previous frame is still.
constexpr double kUnmoved = 1e-5;

// Cost of a reference with a shorter run, in frames of age.
constexpr std::uint32_t kPairPenalty = 1;
constexpr std::uint32_t kSinglePenalty = 4;

struct Attempt {
  std::size_t finer;  // levels
  double inner;       // of the error for joints within the body
  double lambda;
  bool keeps_still;  // still bones are not aimed
};
// Tried in turn until every joint is near enough; the first nearly always suffices.
constexpr std::array<Attempt, 7> kAttempts{{{0, 1.0, 6.0, true},
                                            {0, 0.92, 1.5, true},
                                            {1, 0.92, 1.5, true},
                                            {1, 0.9, 1.5, false},
                                            {1, 0.8, 1e6, false},
                                            {2, 0.8, 1e6, false},
                                            {3, 0.8, 1e6, false}}};

}  // namespace

LatticeEncoder::LatticeEncoder(std::shared_ptr<const PoseModel> model)
    : model_(std::move(model)),
      lattice_(average_skeleton(), model_->rest),
      skeleton_tag_(tag_of(average_skeleton())) {}

// Acknowledgements of frames from before the last request do not count.
bool LatticeEncoder::is_void(std::uint32_t sequence) const {
  return has_void_ && static_cast<std::int32_t>(sequence - void_until_) <= 0;
}

void LatticeEncoder::acknowledged(std::uint32_t sequence) {
  if (is_void(sequence)) return;
  if (CodedFrame* frame = ring_.find(sequence)) frame->is_acknowledged = true;
}

void LatticeEncoder::base_acknowledged(std::uint32_t sequence) {
  if (is_void(sequence)) return;
  if (CodedFrame* frame = ring_.find(sequence)) frame->is_base_acknowledged = true;
}

void LatticeEncoder::request_intra() {
  wants_key_ = true;
  ring_.forget_acknowledged();
  has_void_ = has_last_;
  void_until_ = last_sequence_;
}

void LatticeEncoder::restart() {
  ring_.clear();
  wants_key_ = true;
  has_last_ = false;
  has_void_ = false;
  has_truth_ = false;
  last_capture_ = MonoTime();
}

void LatticeEncoder::set_quality(double error_m) {
  error_m_ = std::clamp(error_m, kLevelErrors_m.front(), kLevelErrors_m.back());
  level_ = 0;
  while (level_ + 1 < kLevelCount && kLevelErrors_m[level_ + 1] <= error_m_) ++level_;
}

void LatticeEncoder::set_skeleton(const Skeleton& skeleton) {
  lattice_ = BodyLattice(skeleton, model_->rest);
  skeleton_tag_ = tag_of(skeleton);
  restart();
}

// Takes effect with the next intra frame, which carries it.
void LatticeEncoder::watch_pace(MonoTime capture) {
  const auto is_usual = [](MonoTime t) {
    return t.is_set() && t > MonoTime() - kOldestCapture && t < MonoTime() + kOldestCapture;
  };
  if (is_usual(last_capture_) && is_usual(capture)) {
    const Duration apart = capture - last_capture_;
    if (apart > Duration() && apart < Duration::ms(200)) pace_ = (pace_ * 7 + apart) / 8;
  }
  last_capture_ = capture;
}

bool LatticeEncoder::may_refer_to(const CodedFrame* frame) const {
  if (frame == nullptr || frame->is_slow != is_slow_) return false;
  if (is_base_ && fixed_age_ == 0) return frame->is_base_acknowledged;
  return (frame->is_acknowledged || fixed_age_ != 0 ||
          (policy_ != References::kAcknowledged && frame->is_chained));
}

LatticeEncoder::Reference LatticeEncoder::reference_of_age(std::uint32_t sequence,
                                                           std::uint32_t age) {
  Reference reference;
  reference.age = age;
  while (reference.run < 4 && age + reference.run <= FrameRing::kOldest) {
    const CodedFrame* frame =
        ring_.find(sequence - age - static_cast<std::uint32_t>(reference.run));
    if (!may_refer_to(frame)) break;
    reference.frames[reference.run++] = frame;
  }
  if (reference.run == 3) reference.run = 2;
  return reference;
}

LatticeEncoder::Reference LatticeEncoder::choose_reference(std::uint32_t sequence) {
  if (wants_key_ || !has_last_) return {};
  const std::uint32_t newest = fixed_age_ != 0 ? fixed_age_ : sequence - last_sequence_;
  if (newest > FrameRing::kOldest) return {};
  if (fixed_age_ != 0 || (policy_ != References::kAcknowledged && !is_base_))
    return reference_of_age(sequence, newest);
  // A run of frames shows motion: it is worth a somewhat older reference.
  Reference best;
  std::uint32_t best_cost = UINT32_MAX;
  for (std::uint32_t age = newest; age <= FrameRing::kOldest; ++age) {
    if (age >= best_cost) break;
    const Reference reference = reference_of_age(sequence, age);
    if (reference.run == 0) continue;
    const std::uint32_t cost = age + (reference.run == 4   ? 0
                                      : reference.run == 2 ? kPairPenalty
                                                           : kSinglePenalty);
    if (cost < best_cost) {
      best_cost = cost;
      best = reference;
    }
  }
  return best;
}

BodyQuantiser::Still LatticeEncoder::still_bones(const TrueBody& truth) const {
  BodyQuantiser::Still still{};
  if (!has_truth_) return still;
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    const exact::Quat& now = truth.local[b];
    const exact::Quat& was = last_local_[b];
    still[b] = std::abs(exact::dot(now, was)) > 1.0 - 0.5 * kUnmoved * kUnmoved;
  }
  return still;
}

bool LatticeEncoder::quantise(const TrueBody& truth, const BodyQuantiser::Still& still,
                              const Reference& reference) {
  std::array<const ReferenceBody*, 4> bodies{};
  for (std::size_t i = 0; i < reference.run; ++i) bodies[i] = &reference.frames[i]->body;
  const ReferenceBody* base = reference.run > 0 ? bodies[0] : nullptr;
  const DistributionTable& table = reference.run > 0 ? model_->table : model_->intra_table;
  for (const Attempt& attempt : kAttempts) {
    used_level_ = level_ - std::min(level_, attempt.finer);
    BodyPredictor predictor(lattice_, *model_, used_level_, is_slow_, reference.age,
                            {bodies.data(), reference.run});
    const QuantiseOptions options{used_level_, error_m_, attempt.inner, attempt.lambda};
    if (quantiser_.quantise(lattice_, predictor, table, truth,
                            attempt.keeps_still ? still : BodyQuantiser::Still{}, base, options))
      return true;
  }
  return false;
}

std::size_t LatticeEncoder::write(const Pose& pose, const Reference& reference,
                                  std::span<std::uint8_t> out) {
  RangeEncoder coder(out);
  const CodedFrame* base = reference.run > 0 ? reference.frames[0] : nullptr;
  const CodedFrame* before = reference.run > 1 ? reference.frames[1] : nullptr;
  FrameHead head;
  head.kind = base != nullptr ? FrameKind::kDelta : FrameKind::kIntra;
  head.age = static_cast<std::uint8_t>(reference.age);
  head.run = static_cast<std::uint8_t>(reference.run);
  head.level = static_cast<std::uint8_t>(used_level_);
  head.is_slow = is_slow_;
  head.skeleton_tag = skeleton_tag_;
  write_head(head, base != nullptr ? base->level : 0, coder);
  write_extras(extras_of(pose), base, before, reference.age, model_->table, coder);
  for (const BodyQuantiser::Choice& choice : quantiser_.choices())
    choice.distribution.encode(choice.symbol, coder);
  if (base != nullptr && has_check(pose.sequence))
    coder.encode_bits(check_of(lattice_, used_level_, skeleton_tag_, quantiser_.body()), 16);
  const std::size_t size = coder.finish();
  if (!coder.ok()) return 0;
  if (size > 0 || out.empty()) return size;
  out[0] = 0;  // a record is never empty
  return 1;
}

std::size_t LatticeEncoder::encode(const Pose& pose, std::span<std::uint8_t> payload) {
  const std::size_t size = encode_frame(pose, payload);
  is_base_ = false;
  return size;
}

std::size_t LatticeEncoder::encode_frame(const Pose& pose, std::span<std::uint8_t> payload) {
  if (!is_valid(pose)) return 0;
  if (has_last_ && pose.sequence - last_sequence_ > INT32_MAX) restart();
  if (has_last_ && pose.sequence == last_sequence_) return 0;
  watch_pace(pose.capture_time);
  const bool is_slow_now = pace_ > kSlowPace;
  if (wants_key_ || !has_last_) is_slow_ = is_slow_now;

  const TrueBody truth = true_body(lattice_, pose);
  const BodyQuantiser::Still still = still_bones(truth);
  const Reference reference = choose_reference(pose.sequence);
  if (reference.run == 0) is_slow_ = is_slow_now;
  if (!quantise(truth, still, reference)) return 0;

  // The previous frame is included where its bytes are available and this one refers to it.
  const bool is_twice = !is_base_ && policy_ == References::kPreviousTwice && reference.run > 0 &&
                        last_size_ > 0 && reference.frames[0]->sequence == last_sequence_;
  const std::size_t lead = is_twice ? kTwiceHeadBytes + last_size_ : 0;
  if (lead >= payload.size()) return 0;
  const std::size_t size = write(pose, reference, payload.subspan(lead));
  if (size == 0) return 0;
  if (is_twice) {
    std::array<std::uint8_t, 8> begin{};
    RangeEncoder coder(begin);
    FrameHead head;
    head.kind = FrameKind::kTwice;
    head.twice_bytes = static_cast<std::uint8_t>(last_size_);
    write_head(head, 0, coder);
    const std::size_t used = coder.finish();
    DANCE_ASSERT(coder.ok() && used <= kTwiceHeadBytes, used);
    std::copy_n(begin.begin(), kTwiceHeadBytes, payload.begin());
    std::copy_n(last_payload_.begin(), last_size_, payload.begin() + kTwiceHeadBytes);
  }
  last_size_ = size <= last_payload_.size() ? size : 0;
  std::copy_n(payload.begin() + static_cast<std::ptrdiff_t>(lead), last_size_,
              last_payload_.begin());

  // An intra frame begins a chain of references.
  is_still_ = reference.run == 0;
  if (is_still_) ring_.break_chain();
  CodedFrame& frame = ring_.make(pose.sequence);
  frame.is_chained = true;
  frame.level = static_cast<std::uint8_t>(used_level_);
  frame.is_slow = is_slow_;
  frame.extras = extras_of(pose);
  frame.body = quantiser_.body();
  wants_key_ = false;
  has_last_ = true;
  last_sequence_ = pose.sequence;
  has_truth_ = true;
  last_local_ = truth.local;
  return lead + size;
}

}  // namespace dance
