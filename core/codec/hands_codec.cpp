#include "core/codec/hands_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/codec/coding/adaptive_bits.h"
#include "core/codec/exact/exact_math.h"

namespace dance {
namespace {

constexpr std::size_t kHandBones = kFingerBoneCount / 2;
constexpr std::size_t kPhalanges = 3;
constexpr std::uint32_t kWholeHand = (1u << kHandBones) - 1;
constexpr int kHalfTurn_steps = 312;
constexpr double kStep_rad = exact::kPi / kHalfTurn_steps;

// Form of each hand in the first byte, two bits each, left lowest.
enum class HandForm : std::uint8_t {
  kNone,   // nothing measured, all at rest
  kWhole,  // every bone measured
  kParts,  // masks follow: bones measured, bones carried
};

// A rotation vector in steps, mirrored so that both hands are alike: curl towards the palm, spread
// about the vertical, twist about the arm, as they are in T-pose with palms down.
using Turn = std::array<int, 3>;
using HandTurns = std::array<Turn, kHandBones>;

struct HandMasks {
  std::uint32_t measured = 0;
  std::uint32_t carried = 0;
};

// Recent mean residual, from which the next one's distribution follows.
class RecentSize {
 public:
  explicit RecentSize(std::uint32_t mean_steps) : mean_(mean_steps * kOne) {}

  // Probability, in 1/2^16, that a difference of at least n steps is larger than n: constant at
  // first, then growing, so that outliers stay affordable.
  std::uint32_t goes_on(std::uint32_t n) const {
    const std::uint64_t reach = mean_ + n * n * kOne * (kOne / 4) / (mean_ + kOne);
    return std::clamp(static_cast<std::uint32_t>(reach * kWhole / (reach + kOne)), kWhole / 64,
                      kWhole - kWhole / 64);
  }
  void learn(std::uint32_t difference) { mean_ = (2 * mean_ + difference * kOne) / 3; }

 private:
  static constexpr std::uint32_t kWhole = AdaptiveBit::kWhole;
  static constexpr std::uint32_t kOne = 256;
  std::uint32_t mean_;  // in 1/256 step
};

constexpr std::uint32_t kLongestCount = 40;
constexpr int kRestBits = 10;

template <class Coder>
int code_difference(Coder& coder, RecentSize& spread, int difference) {
  const auto size = static_cast<std::uint32_t>(std::abs(difference));
  std::uint32_t n = 0;
  while (n < kLongestCount && coder.likely_bit(spread.goes_on(n), size > n)) ++n;
  if (n == kLongestCount) n += coder.raw(size - kLongestCount, kRestBits);
  spread.learn(n);
  if (n == 0) return 0;
  return coder.raw(difference < 0 ? 1u : 0u, 1) != 0 ? -static_cast<int>(n) : static_cast<int>(n);
}

// The means of one message, shared by both hands.
struct RecentSizes {
  // thumb or finger; first phalanx or another; curl, spread, twist
  std::array<std::array<std::array<RecentSize, 3>, 2>, 2> of{
      {{{{RecentSize(6), RecentSize(6), RecentSize(4)},
         {RecentSize(5), RecentSize(3), RecentSize(2)}}},
       {{{RecentSize(8), RecentSize(3), RecentSize(2)},
         {RecentSize(6), RecentSize(1), RecentSize(1)}}}}};
};

// Prediction of a bone from those before: its curl from the same bone of the finger beside it and
// from the bone before it; spread and twist from its peers so far. Thumbs and first fingers have a
// peer in the other hand only.
Turn expected_turn(const HandTurns& turns, const HandTurns& other, std::size_t bone) {
  const bool has_neighbour = bone >= 2 * kPhalanges;
  const auto beside = [&](std::size_t b) {
    return has_neighbour ? turns[b - kPhalanges] : other[b];
  };
  Turn expected = beside(bone);
  if (bone % kPhalanges != 0) expected[0] += (turns[bone - 1][0] - beside(bone - 1)[0]) * 5 / 8;
  expected[0] = std::clamp(expected[0], -kHalfTurn_steps, kHalfTurn_steps);
  for (std::size_t axis = 1; axis < 3; ++axis) {
    int sum = other[bone][axis];
    int peers = 1;
    for (std::size_t b = kPhalanges + bone % kPhalanges; b < bone; b += kPhalanges, ++peers)
      sum += turns[b][axis];
    expected[axis] = sum / peers;
  }
  return expected;
}

template <class Coder>
bool code_hand(Coder& coder, RecentSizes& spreads, std::uint32_t carried, const HandTurns& other,
               HandTurns& turns) {
  for (std::size_t b = 0; b < kHandBones; ++b) {
    if ((carried >> b & 1u) == 0) {
      turns[b] = {};
      continue;
    }
    const Turn expected = expected_turn(turns, other, b);
    auto& means = spreads.of[b < kPhalanges ? 0 : 1][b % kPhalanges == 0 ? 0 : 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int wanted = turns[b][axis] - expected[axis];
      turns[b][axis] = expected[axis] + code_difference(coder, means[axis], wanted);
      if (std::abs(turns[b][axis]) > kHalfTurn_steps) return false;
    }
  }
  return true;
}

// Mirrors left and right: right hands are coded as left ones.
Turn to_turn(const Eigen::Quaternionf& rotation, bool is_left) {
  const Eigen::Vector4d q = rotation.coeffs().cast<double>();
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = std::sqrt(q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  const double angle_rad = 2.0 * exact::atan2(sine, sign * q.w());
  const double scale = sine > 0.0 ? sign * angle_rad / (sine * kStep_rad) : 0.0;
  const double side = is_left ? scale : -scale;
  const auto steps = [](double x) { return static_cast<int>(exact::round_to_whole(x)); };
  return {steps(-side * q.z()), steps(side * q.y()), steps(scale * q.x())};
}

Eigen::Quaternionf to_rotation(const Turn& turn, bool is_left) {
  const double side = is_left ? kStep_rad : -kStep_rad;
  const double x = turn[2] * kStep_rad;
  const double y = turn[1] * side;
  const double z = -turn[0] * side;
  const double angle_rad = std::sqrt(x * x + y * y + z * z);
  if (angle_rad == 0.0) return Eigen::Quaternionf::Identity();
  const double scale = exact::sin(0.5 * angle_rad) / angle_rad;
  return Eigen::Quaternionf(static_cast<float>(exact::cos(0.5 * angle_rad)),
                            static_cast<float>(scale * x), static_cast<float>(scale * y),
                            static_cast<float>(scale * z));
}

HandMasks masks_of(const Hands& hands, const HandTurns& turns, std::size_t first) {
  HandMasks masks;
  masks.measured = hands.presence >> first & kWholeHand;
  masks.carried = masks.measured;
  for (std::size_t b = 0; b < kHandBones; ++b)
    if (turns[b] != Turn{}) masks.carried |= 1u << b;
  return masks;
}

HandForm form_of(const HandMasks& masks) {
  if (masks.carried == 0) return HandForm::kNone;
  return masks.measured == kWholeHand ? HandForm::kWhole : HandForm::kParts;
}

}  // namespace

std::size_t encode_hands(const Hands& hands, std::span<std::uint8_t> payload) {
  if (!is_valid(hands) || payload.empty()) return 0;
  BitEncoder coder(payload.subspan(1));
  RecentSizes spreads;
  std::array<HandTurns, 2> turns{};
  payload[0] = 0;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const std::size_t first = hand * kHandBones;
    for (std::size_t b = 0; b < kHandBones; ++b)
      turns[hand][b] = to_turn(hands.R_PB[first + b], hand == 0);
    const HandMasks masks = masks_of(hands, turns[hand], first);
    const HandForm form = form_of(masks);
    payload[0] |= static_cast<std::uint8_t>(static_cast<unsigned>(form) << (2 * hand));
    if (form == HandForm::kParts) {
      coder.raw(masks.measured, kHandBones);
      coder.raw(masks.carried, kHandBones);
    }
    code_hand(coder, spreads, masks.carried, hand == 0 ? HandTurns{} : turns[0], turns[hand]);
  }
  const std::size_t size = coder.finish();
  return coder.ok() ? 1 + size : 0;
}

bool decode_hands(std::span<const std::uint8_t> payload, Hands& hands) {
  if (payload.empty() || payload[0] >> 4 != 0) return false;
  BitDecoder coder(payload.subspan(1));
  RecentSizes spreads;
  std::array<HandTurns, 2> turns{};
  hands.presence = 0;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const std::size_t first = hand * kHandBones;
    HandMasks masks;
    switch (static_cast<HandForm>(payload[0] >> (2 * hand) & 3u)) {
      case HandForm::kNone:
        break;
      case HandForm::kWhole:
        masks = {kWholeHand, kWholeHand};
        break;
      case HandForm::kParts:
        masks.measured = coder.raw(0, kHandBones);
        masks.carried = coder.raw(0, kHandBones);
        if ((masks.measured & ~masks.carried) != 0) return false;
        break;
      default:
        return false;
    }
    hands.presence |= masks.measured << first;
    if (!code_hand(coder, spreads, masks.carried, hand == 0 ? HandTurns{} : turns[0], turns[hand]))
      return false;
    for (std::size_t b = 0; b < kHandBones; ++b)
      hands.R_PB[first + b] = to_rotation(turns[hand][b], hand == 0);
  }
  return coder.is_exhausted() && is_valid(hands);
}

}  // namespace dance
