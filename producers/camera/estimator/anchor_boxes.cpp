#include "producers/camera/estimator/anchor_boxes.h"

#include <algorithm>

#include "core/base/assert.h"
#include "producers/camera/estimator/pose_engine.h"

namespace dance {
namespace {

constexpr float kLeastOverlap = 0.3f, kMostRaw = 100.0f;

float overlap(const AnchorBox& one, const AnchorBox& other) {
  const auto &a = one.at, &b = other.at;
  const float width = std::min(a[2], b[2]) - std::max(a[0], b[0]);
  const float height = std::min(a[3], b[3]) - std::max(a[1], b[1]);
  if (width <= 0.0f || height <= 0.0f) return 0.0f;
  const float both = width * height;
  const float either = (a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both;
  return either > 0.0f ? both / either : 0.0f;
}

}  // namespace

AnchorBoxes::AnchorBoxes(std::span<const AnchorGrid> grids, std::size_t numbers, float side_px)
    : numbers_(numbers), side_px_(side_px) {
  DANCE_ASSERT(numbers >= AnchorBox::kBoxNumbers && numbers <= AnchorBox::kMostNumbers, numbers);
  for (const AnchorGrid& grid : grids)
    for (int y = 0; y < grid.cells; ++y)
      for (int x = 0; x < grid.cells; ++x)
        for (int i = 0; i < grid.anchors; ++i)
          anchors_.push_back({(static_cast<float>(x) + 0.5f) / static_cast<float>(grid.cells),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(grid.cells)});
  boxes_.reserve(anchors_.size());
}

void AnchorBoxes::decode(std::span<const float> boxes, std::span<const float> scores,
                         float least_score) {
  boxes_.clear();
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const float score = sigmoid(std::clamp(scores[i], -kMostRaw, kMostRaw));
    if (!(score >= least_score)) continue;
    const std::span<const float> raw = boxes.subspan(i * numbers_, numbers_);
    if (!all_finite(raw)) continue;
    AnchorBox& box = boxes_.emplace_back();
    box.score = score;
    const float x = raw[0] / side_px_ + anchors_[i].x(), y = raw[1] / side_px_ + anchors_[i].y();
    const float width = raw[2] / side_px_, height = raw[3] / side_px_;
    box.at = {x - 0.5f * width, y - 0.5f * height, x + 0.5f * width, y + 0.5f * height};
    for (std::size_t k = AnchorBox::kBoxNumbers; k < numbers_; ++k)
      box.at[k] = raw[k] / side_px_ + anchors_[i][static_cast<int>(k % 2)];
  }
  std::sort(boxes_.begin(), boxes_.end(),
            [](const AnchorBox& a, const AnchorBox& b) { return a.score > b.score; });
}

AnchorBox AnchorBoxes::take_surest() {
  const AnchorBox best = boxes_.front();
  AnchorBox merged = best;
  merged.at.fill(0.0f);
  float total = 0.0f;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const AnchorBox& box = boxes_[i];
    if (i != 0 && overlap(box, best) <= kLeastOverlap) {
      boxes_[kept++] = box;
      continue;
    }
    total += box.score;
    for (std::size_t k = 0; k < numbers_; ++k) merged.at[k] += box.score * box.at[k];
  }
  boxes_.resize(kept);
  for (float& value : merged.at) value /= total;
  return merged;
}

}  // namespace dance
