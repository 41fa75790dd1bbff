#include "producers/camera/face/face_solver.h"

#include <algorithm>
#include <cmath>

#include "core/base/median.h"
#include "core/pose/mirror.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// What noise makes of a face at rest.
constexpr float kQuiet = 0.08f;
constexpr OneEuroSetting kWeights{2.0, 1.5, 1.0};
constexpr OneEuroSetting kGaze{1.0, 1.0, 1.0};
// At which ARKit's looks are full.
constexpr float kFullLook_rad = 0.6f;
constexpr double kFaceFirst_hz = 30.0;
// Longer than a slow machine takes until it looks again.
constexpr Duration kFaceKept = Duration::ms(500);
constexpr Duration kFaceFades = Duration::ms(700);
// Further aside the points of the far half are guesses.
constexpr float kLeastAhead = 0.7f;

// By how many pixels points of a face at rest wander.
constexpr float kNoise_px = 0.7f;

// 0 at rest, 1 where the difference is `full`.
float shown(float difference, float full) {
  const float share = difference / full;
  return std::clamp((share - kQuiet) / (1.0f - kQuiet), 0.0f, 1.0f);
}

struct Reading {
  const FaceFeatures& is;
  const FaceFeatures& rest;
  std::array<float, kExpressionCount>& weight;

  float more(std::size_t feature) const { return is[feature] - rest[feature]; }
  float less(std::size_t feature) const { return rest[feature] - is[feature]; }
  // As shares of what it is at rest.
  float more_of(std::size_t feature) const {
    return more(feature) / std::max(0.02f, rest[feature]);
  }
  void set(Expression e, float value) const { weight[index_of(e)] = value; }
  // Of both sides: the right one's number is the next.
  void set_side(Expression left, std::size_t side, float value) const {
    weight[index_of(left) + side] = value;
  }
};

void read_eyes(const Reading& r) {
  for (std::size_t side = 0; side < 2; ++side) {
    const float lids = r.more_of(kLidGap + side);
    r.set_side(Expression::kEyeBlinkLeft, side, shown(-lids, 0.75f));
    r.set_side(Expression::kEyeWideLeft, side, shown(lids, 0.5f));
    r.set_side(Expression::kEyeSquintLeft, side, shown(r.more(kLowerLid + side), 0.035f));
    r.set_side(Expression::kBrowDownLeft, side, shown(r.less(kInnerBrow + side), 0.06f));
    r.set_side(Expression::kBrowOuterUpLeft, side, shown(r.more(kOuterBrow + side), 0.09f));
    r.set_side(Expression::kNoseSneerLeft, side, shown(r.more(kNoseWing + side), 0.06f));
    r.set_side(Expression::kCheekSquintLeft, side, shown(r.less(kCheek + side), 0.08f));
  }
  r.set(Expression::kBrowInnerUp,
        shown(0.5f * (r.more(kInnerBrow) + r.more(kInnerBrow + 1)), 0.09f));
}

void read_jaw(const Reading& r) {
  const float open = r.more(kChinDown), aside = r.more(kChinLeft), gap = r.more(kLipGap);
  r.set(Expression::kJawOpen, shown(open, 0.35f));
  r.set(Expression::kMouthClose, shown(open - gap, 0.35f) * shown(open, 0.1f));
  r.set(Expression::kJawLeft, shown(aside, 0.12f));
  r.set(Expression::kJawRight, shown(-aside, 0.12f));
}

void read_lips(const Reading& r) {
  const float narrow = -r.more_of(kMouthWidth), gap = r.more(kLipGap);
  const float pursed = shown(narrow, 0.35f), parted = shown(gap, 0.15f);
  r.set(Expression::kMouthFunnel, pursed * parted);
  r.set(Expression::kMouthPucker, pursed * (1.0f - parted));
  const float aside = 0.5f * (r.more(kMouthCornerOut) - r.more(kMouthCornerOut + 1));
  r.set(Expression::kMouthLeft, shown(aside, 0.12f));
  r.set(Expression::kMouthRight, shown(-aside, 0.12f));
  const float upper = shown(-r.more_of(kUpperLipRed), 0.7f) * (1.0f - parted);
  const float lower = shown(-r.more_of(kLowerLipRed), 0.7f) * (1.0f - parted);
  r.set(Expression::kMouthRollUpper, upper);
  r.set(Expression::kMouthRollLower, lower);
  const float closed = (1.0f - parted) * (1.0f - shown(r.more(kChinDown), 0.15f));
  r.set(Expression::kMouthShrugLower, shown(r.more(kLowerLipUp), 0.09f) * closed);
  r.set(Expression::kMouthShrugUpper, shown(r.more(kUpperLipUp), 0.06f) * closed);
  for (std::size_t side = 0; side < 2; ++side) {
    const float up = r.more(kMouthCornerUp + side), out = r.more(kMouthCornerOut + side);
    // An open jaw takes the corners down with it.
    const float lifted = up + 0.25f * std::max(0.0f, r.more(kChinDown));
    const float smile = shown(0.5f * out + lifted, 0.16f);
    r.set_side(Expression::kMouthSmileLeft, side, smile);
    r.set_side(Expression::kMouthFrownLeft, side, shown(-lifted, 0.08f));
    r.set_side(Expression::kMouthStretchLeft, side, shown(out, 0.12f) * (1.0f - smile));
    r.set_side(Expression::kMouthPressLeft, side, std::min(upper, lower));
    r.set_side(Expression::kMouthUpperUpLeft, side,
               shown(r.more(kUpperLip + side), 0.08f) * parted);
    r.set_side(Expression::kMouthLowerDownLeft, side,
               shown(r.less(kLowerLip + side), 0.08f) * parted);
  }
}

}  // namespace

std::array<float, kExpressionCount> expressions_of(const FaceFeatures& is, const FaceFeatures& rest,
                                                   float noise) {
  std::array<float, kExpressionCount> weight{};
  // What is within the noise is as at rest, and what is beyond it begins there.
  FaceFeatures clear;
  for (std::size_t f = 0; f < kFaceFeatureCount; ++f) {
    const float off = is[f] - rest[f];
    clear[f] = rest[f] + (off > noise ? off - noise : off < -noise ? off + noise : 0.0f);
  }
  const Reading reading{clear, rest, weight};
  read_eyes(reading);
  read_jaw(reading);
  read_lips(reading);
  for (float& w : weight)
    if (!std::isfinite(w)) w = 0.0f;
  return weight;
}

// True once the face at rest is known: the median of each feature, so that a blink or a word is
// none of it.
bool FaceSolver::learn_rest(const CapturedFaceShape& shape) {
  if (knows_rest()) return true;
  sample_[samples_++] = shape.features;
  if (!knows_rest()) return false;
  for (std::size_t f = 0; f < kFaceFeatureCount; ++f) {
    std::array<float, kSamples> values;
    for (std::size_t i = 0; i < kSamples; ++i) values[i] = sample_[i][f];
    rest_[f] = median_of<float>(values);
  }
  return true;
}

void FaceSolver::see(const FaceLandmarks& face, MonoTime now) {
  const auto shape = face.found ? shape_of(face) : std::nullopt;
  is_seen_ = shape.has_value();
  if (!shape) return;
  R_CHead_ = shape->R_CHead;
  const double passed_s = has_seen_ ? (now - seen_).as_seconds() : 0.0;
  if (has_seen_ && now - seen_ > kFaceKept) filters_ = {};
  seen_ = now;
  has_seen_ = true;
  // −z of the camera is towards it. A face that is turned far aside keeps its expression.
  const float ahead = -(R_CHead_ * Vector3f::UnitZ()).z();
  if (ahead < kLeastAhead || !learn_rest(*shape)) return;
  const double hz = passed_s > 0.0 ? 1.0 / passed_s : kFaceFirst_hz;
  OneEuroSetting setting = kWeights;
  setting.min_cutoff_hz /= std::max(0.05, smooth_);
  const auto seen = expressions_of(shape->features, rest_, kNoise_px / shape->eyes_px);
  for (std::size_t i = 0; i < kExpressionCount; ++i)
    weight_[i] = std::clamp(filters_[i].next(seen[i], hz, 1.0, setting), 0.0f, 1.0f);
}

void FaceSolver::see_gaze(const std::optional<Eigen::Vector2f>& gaze_rad) {
  has_gaze_ = false;
  if (!is_seen_ || !gaze_rad || !gaze_rad->allFinite()) return;
  if (!knows_rest() || gazes_ == 0) {
    gaze_sum_rad_ += *gaze_rad;
    ++gazes_;
    return;
  }
  const Eigen::Vector2f off = *gaze_rad - gaze_sum_rad_ / static_cast<float>(gazes_);
  for (int k = 0; k < 2; ++k)
    gaze_rad_[k] = std::clamp(
        gaze_filters_[static_cast<std::size_t>(k)].next(off[k], kFaceFirst_hz, 1.0, kGaze),
        -kMostGaze_rad, kMostGaze_rad);
  has_gaze_ = true;
}

bool FaceSolver::write(MonoTime now, Face& out) const {
  out.presence = 0;
  if (!has_seen_) return false;
  // It may not have been looked for since.
  if (is_seen_ && now - seen_ <= kFaceKept) out.presence = kFaceSeen;
  const double past = (now - seen_ - kFaceKept).as_seconds() / kFaceFades.as_seconds();
  const auto share = static_cast<float>(1.0 - std::clamp(past, 0.0, 1.0));
  for (std::size_t i = 0; i < kExpressionCount; ++i) out.weight[i] = share * weight_[i];
  if (!has_gaze_ || out.presence == 0) return share > 0.0f;
  out.presence |= kGazeSeen;
  out.gaze_rad = {gaze_rad_.x(), gaze_rad_.y()};
  const auto look = [&](Expression left_eye, Expression right_eye, float angle) {
    const float value = std::clamp(angle / kFullLook_rad, 0.0f, 1.0f);
    out[left_eye] = value;
    out[right_eye] = value;
  };
  using E = Expression;
  look(E::kEyeLookOutLeft, E::kEyeLookInRight, gaze_rad_.x());
  look(E::kEyeLookInLeft, E::kEyeLookOutRight, -gaze_rad_.x());
  look(E::kEyeLookUpLeft, E::kEyeLookUpRight, gaze_rad_.y());
  look(E::kEyeLookDownLeft, E::kEyeLookDownRight, -gaze_rad_.y());
  return share > 0.0f;
}

void FaceSolver::reset() {
  const double smooth = smooth_;
  *this = FaceSolver(smooth);
}

void mirror(Face& face) {
  for (std::size_t i = 0; i + 1 < kExpressionCount; ++i) {
    const std::string_view name = kExpressionNames[i];
    if (!name.ends_with("Left") || i == index_of(Expression::kJawLeft) ||
        i == index_of(Expression::kMouthLeft))
      continue;
    std::swap(face.weight[i], face.weight[i + 1]);
  }
  std::swap(face[Expression::kJawLeft], face[Expression::kJawRight]);
  std::swap(face[Expression::kMouthLeft], face[Expression::kMouthRight]);
  face.R_PB = mirrored(face.R_PB);
  face.gaze_rad[0] = -face.gaze_rad[0];
}

}  // namespace dance
