#include "producers/camera/people/body_mask.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dance {
namespace {

// Of a body's measure.
constexpr float kArm = 0.035f, kLeg = 0.055f, kTrunk = 0.045f, kHead = 0.075f;
// Pixels beside the mask that say what is painted over it, and how far away they may be.
constexpr int kBeside = 4, kFarthestBeside = 48;
// What moves from one picture to the next.
constexpr float kAround = 0.03f;

struct Bar {
  Landmark from, to;
  float radius;
};
constexpr Bar kBars[]{
    {Landmark::kLeftShoulder, Landmark::kLeftElbow, kArm},
    {Landmark::kLeftElbow, Landmark::kLeftWrist, kArm},
    {Landmark::kLeftWrist, Landmark::kLeftIndex, kArm},
    {Landmark::kRightShoulder, Landmark::kRightElbow, kArm},
    {Landmark::kRightElbow, Landmark::kRightWrist, kArm},
    {Landmark::kRightWrist, Landmark::kRightIndex, kArm},
    {Landmark::kLeftHip, Landmark::kLeftKnee, kLeg},
    {Landmark::kLeftKnee, Landmark::kLeftAnkle, kLeg},
    {Landmark::kLeftHeel, Landmark::kLeftFootIndex, kArm},
    {Landmark::kRightHip, Landmark::kRightKnee, kLeg},
    {Landmark::kRightKnee, Landmark::kRightAnkle, kLeg},
    {Landmark::kRightHeel, Landmark::kRightFootIndex, kArm},
    {Landmark::kLeftShoulder, Landmark::kRightShoulder, kTrunk},
    {Landmark::kLeftHip, Landmark::kRightHip, kLeg},
    {Landmark::kLeftEar, Landmark::kRightEar, kHead},
};
// Bars from one side of the trunk to the other fill it.
constexpr int kTrunkBars = 6;
// Limbs that the network only guesses hide nothing.
constexpr float kSeen = 0.3f;

}  // namespace

void BodyMask::begin(const BodyRegion& region, int side_px) {
  side_px_ = std::clamp(side_px, 1, kMostSide_px);
  frame_ = RegionFrame(region);
  scale_ = static_cast<float>(side_px_) / std::max(1.0f, region.side_px);
  if (!is_empty_) cells_.fill(Cell::kFree);
  is_empty_ = true;
}

Eigen::Vector2f BodyMask::place(const Eigen::Vector2f& p_px) const {
  const float half = 0.5f * static_cast<float>(side_px_);
  return Eigen::Vector2f(half, half) + scale_ * frame_.offset(p_px);
}

void BodyMask::fill(const Eigen::Vector2f& a, const Eigen::Vector2f& b, float radius, Cell cell) {
  const auto edge = static_cast<float>(side_px_);
  if (!a.allFinite() || !b.allFinite() || !(radius < edge) ||
      std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()) > 8.0f * edge)
    return;
  is_empty_ = false;
  const auto low = [&](float p, float q) {
    return static_cast<int>(std::clamp(std::min(p, q) - radius, 0.0f, edge));
  };
  const auto high = [&](float p, float q) {
    return static_cast<int>(std::clamp(std::max(p, q) + radius + 1.0f, 0.0f, edge));
  };
  const Eigen::Vector2f bar = b - a;
  const float squared = std::max(bar.squaredNorm(), 1e-6f);
  for (int y = low(a.y(), b.y()); y < high(a.y(), b.y()); ++y)
    for (int x = low(a.x(), b.x()); x < high(a.x(), b.x()); ++x) {
      const Eigen::Vector2f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float share = std::clamp((p - a).dot(bar) / squared, 0.0f, 1.0f);
      if ((p - a - share * bar).squaredNorm() <= radius * radius) cells_[index(x, y)] = cell;
    }
}

void BodyMask::add(const SeenBody& body) { set(body, 0.0f, Cell::kMasked); }
void BodyMask::spare(const SeenBody& body) { set(body, kAround, Cell::kSpared); }

void BodyMask::set(const SeenBody& body, float thicker, Cell cell) {
  const float measure = body.size_px() * scale_;
  const auto at = [&](Landmark l) { return place(body.place_px(l)); };
  for (const Bar& bar : kBars)
    if (std::min(body.visibility[index_of(bar.from)], body.visibility[index_of(bar.to)]) > kSeen)
      fill(at(bar.from), at(bar.to), (bar.radius + thicker) * measure, cell);
  for (int i = 0; i <= kTrunkBars; ++i) {
    const float down = static_cast<float>(i) / static_cast<float>(kTrunkBars);
    const auto between = [&](Landmark shoulder, Landmark hip) {
      return Eigen::Vector2f(at(shoulder) + down * (at(hip) - at(shoulder)));
    };
    fill(between(Landmark::kLeftShoulder, Landmark::kLeftHip),
         between(Landmark::kRightShoulder, Landmark::kRightHip), (kTrunk + thicker) * measure,
         cell);
  }
}

bool BodyMask::covers(const Eigen::Vector2f& place_px) const {
  const Eigen::Vector2f p = place(place_px);
  const auto edge = static_cast<float>(side_px_);
  if (!(p.x() >= 0.0f) || !(p.y() >= 0.0f) || !(p.x() < edge) || !(p.y() < edge)) return false;
  return is_masked(static_cast<int>(p.x()), static_cast<int>(p.y()));
}

std::optional<Eigen::Vector3f> BodyMask::mean(std::span<const float> pixels, int x, int step,
                                              int y) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  for (int i = 0; i < kFarthestBeside && count < kBeside && x >= 0 && x < side_px_;
       ++i, x += step) {
    const Cell cell = cells_[index(x, y)];
    if (cell == Cell::kMasked && count > 0) break;
    if (cell != Cell::kFree) continue;
    sum += Eigen::Map<const Eigen::Vector3f>(pixels.data() + 3 * index(x, y));
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Eigen::Vector3f(sum / static_cast<float>(count));
}

void BodyMask::paint_run(std::span<float> pixels, int from, int to, int y) const {
  const auto left = mean(pixels, from - 1, -1, y), right = mean(pixels, to, 1, y);
  const Eigen::Vector3f a = left    ? *left
                            : right ? *right
                                    : Eigen::Vector3f(Eigen::Vector3f::Constant(0.5f)),
                        b = right ? *right : a;
  for (int x = from; x < to; ++x) {
    const float share = (static_cast<float>(x - from) + 0.5f) / static_cast<float>(to - from);
    Eigen::Map<Eigen::Vector3f>(pixels.data() + 3 * index(x, y)) = a + share * (b - a);
  }
}

void BodyMask::paint_over(std::span<float> pixels) const {
  if (is_empty_) return;
  for (int y = 0; y < side_px_; ++y)
    for (int x = 0; x < side_px_; ++x) {
      if (!is_masked(x, y)) continue;
      int end = x;
      while (end < side_px_ && is_masked(end, y)) ++end;
      paint_run(pixels, x, end, y);
      x = end;
    }
}

}  // namespace dance
