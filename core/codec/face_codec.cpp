#include "core/codec/face_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/codec/coding/adaptive_bits.h"

namespace dance {
namespace {

constexpr int kWeightSteps = 31, kWeightBits = 5;
constexpr int kFaceHeadBits = 7, kFaceGazeBits = 6;
constexpr float kQuarterTurn_rad = 0.5f * std::numbers::pi_v<float>;

using FaceNumbers = std::array<int, kExpressionCount>;
struct FaceSteps {
  std::uint32_t presence = 0;
  FaceNumbers weights{};
  std::array<int, 3> head{};
  std::array<int, 2> gaze{};
};

// A number within ±`most` as one of 2^bits − 1 steps.
int to_step(float value, float most, int bits) {
  const int half = (1 << (bits - 1)) - 1;
  return std::clamp(static_cast<int>(std::lround(value / most * static_cast<float>(half))), -half,
                    half) +
         half;
}
float from_step(int step, float most, int bits) {
  const int half = (1 << (bits - 1)) - 1;
  return static_cast<float>(step - half) / static_cast<float>(half) * most;
}

// The left one of a right expression, which stands before it; −1 of others.
constexpr std::array<int, kExpressionCount> left_of_right() {
  std::array<int, kExpressionCount> left{};
  left.fill(-1);
  for (std::size_t i = 1; i < kExpressionCount; ++i) {
    const std::string_view name = kExpressionNames[i], before = kExpressionNames[i - 1];
    if (name.ends_with("Right") && before.ends_with("Left") &&
        name.substr(0, name.size() - 5) == before.substr(0, before.size() - 4))
      left[i] = static_cast<int>(i) - 1;
  }
  return left;
}
constexpr auto kLeftOfRight = left_of_right();

// How likely an expression is shown, in 1/65,536.
std::uint32_t shown_odds(std::size_t i, const FaceNumbers& weights) {
  constexpr std::uint32_t kRare = 700, kUsual = 14000, kNeither = 3000, kBoth = 60000;
  switch (static_cast<Expression>(i)) {
    case Expression::kCheekPuff:
    case Expression::kJawForward:
    case Expression::kMouthDimpleLeft:
    case Expression::kMouthDimpleRight:
    case Expression::kTongueOut:
      return kRare;
    default:
      break;
  }
  const int left = kLeftOfRight[i];
  if (left < 0) return kUsual;
  return weights[static_cast<std::size_t>(left)] == 0 ? kNeither : kBoth;
}

// A difference from the left one: longer ones are less likely; then its sign.
template <class Coder>
int code_offset(Coder& coder, int offset) {
  constexpr std::uint32_t kGoesOn = 36000;
  constexpr int kLongestOffset = 8;
  int n = 0;
  while (n < kLongestOffset && coder.likely_bit(kGoesOn, std::abs(offset) > n)) ++n;
  if (n == kLongestOffset)
    n += static_cast<int>(
        coder.raw(static_cast<std::uint32_t>(std::abs(offset) - kLongestOffset), kWeightBits));
  if (n == 0) return 0;
  return coder.raw(offset < 0 ? 1u : 0u, 1) != 0 ? -n : n;
}

template <class Coder>
bool code_face(Coder& coder, FaceSteps& steps) {
  steps.presence = coder.raw(steps.presence, 2);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    int& weight = steps.weights[i];
    if (!coder.likely_bit(shown_odds(i, steps.weights), weight != 0)) {
      weight = 0;
      continue;
    }
    const int left = kLeftOfRight[i];
    const int beside = left < 0 ? 0 : steps.weights[static_cast<std::size_t>(left)];
    if (beside > 0)
      weight = beside + code_offset(coder, weight - beside);
    else
      weight = static_cast<int>(coder.raw(static_cast<std::uint32_t>(weight), kWeightBits));
    if (weight < 1 || weight > kWeightSteps) return false;
  }
  const auto code = [&](int& number, int bits) {
    number = static_cast<int>(coder.raw(static_cast<std::uint32_t>(number), bits));
    return number < (1 << bits) - 1;
  };
  for (int& number : steps.head)
    if (!code(number, kFaceHeadBits)) return false;
  if ((steps.presence & kGazeSeen) == 0) return true;
  for (int& number : steps.gaze)
    if (!code(number, kFaceGazeBits)) return false;
  return true;
}

}  // namespace

std::size_t encode_face(const Face& face, std::span<std::uint8_t> payload) {
  if (!is_valid(face) || payload.empty()) return 0;
  FaceSteps steps;
  steps.presence = face.presence & (kFaceSeen | kGazeSeen);
  for (std::size_t i = 0; i < kExpressionCount; ++i)
    steps.weights[i] = static_cast<int>(std::lround(face.weight[i] * kWeightSteps));
  const Eigen::AngleAxisf turn(face.R_PB.w() < 0.0f ? Eigen::Quaternionf(-face.R_PB.coeffs())
                                                    : face.R_PB);
  const Eigen::Vector3f head = turn.angle() * turn.axis();
  for (std::size_t k = 0; k < 3; ++k)
    steps.head[k] = to_step(head[static_cast<int>(k)], kQuarterTurn_rad, kFaceHeadBits);
  for (std::size_t k = 0; k < 2; ++k)
    steps.gaze[k] = to_step(face.gaze_rad[k], kQuarterTurn_rad, kFaceGazeBits);
  BitEncoder coder(payload);
  code_face(coder, steps);
  const std::size_t size = coder.finish();
  return coder.ok() ? size : 0;
}

bool decode_face(std::span<const std::uint8_t> payload, Face& face) {
  if (payload.empty() || payload.size() > kMaxFacePayload) return false;
  FaceSteps steps;
  BitDecoder coder(payload);
  if (!code_face(coder, steps) || !coder.is_exhausted()) return false;
  face.presence = steps.presence;
  for (std::size_t i = 0; i < kExpressionCount; ++i)
    face.weight[i] = static_cast<float>(steps.weights[i]) / static_cast<float>(kWeightSteps);
  Eigen::Vector3f head;
  for (std::size_t k = 0; k < 3; ++k)
    head[static_cast<int>(k)] = from_step(steps.head[k], kQuarterTurn_rad, kFaceHeadBits);
  const float angle = head.norm();
  face.R_PB = angle > 0.0f ? Eigen::Quaternionf(Eigen::AngleAxisf(angle, head / angle))
                           : Eigen::Quaternionf::Identity();
  const bool has_gaze = (steps.presence & kGazeSeen) != 0;
  for (std::size_t k = 0; k < 2; ++k)
    face.gaze_rad[k] = has_gaze ? from_step(steps.gaze[k], kQuarterTurn_rad, kFaceGazeBits) : 0.0f;
  return is_valid(face);
}

}  // namespace dance
