#include "producers/camera/estimator/person_detector.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr float kLeastOverlap = 0.3f;
constexpr std::size_t kBoxNumbers = 4;

struct AnchorGrid {
  int cells = 0;    // in a row, and rows
  int anchors = 0;  // in each cell
};
constexpr AnchorGrid kGrids[] = {{28, 2}, {14, 2}, {7, 6}};

float overlap(const float* a, const float* b) {
  const float width = std::min(a[2], b[2]) - std::max(a[0], b[0]);
  const float height = std::min(a[3], b[3]) - std::max(a[1], b[1]);
  if (width <= 0.0f || height <= 0.0f) return 0.0f;
  const float both = width * height;
  const float either = (a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both;
  return either > 0.0f ? both / either : 0.0f;
}

}  // namespace

PersonDetector::PersonDetector(std::unique_ptr<PoseEngine> engine) : engine_(std::move(engine)) {
  for (const AnchorGrid& grid : kGrids)
    for (int y = 0; y < grid.cells; ++y)
      for (int x = 0; x < grid.cells; ++x)
        for (int i = 0; i < grid.anchors; ++i)
          anchors_.push_back({(static_cast<float>(x) + 0.5f) / static_cast<float>(grid.cells),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(grid.cells)});
  candidates_.reserve(kAnchors);
}

Result<PersonDetector> PersonDetector::make(EngineKind engine, PoseGraph graph) {
  int boxes = -1, scores = -1;
  for (const int output : graph.outputs) {
    if (graph.shape(output) == Shape{1, kAnchors, kNumbers}) boxes = output;
    if (graph.shape(output) == Shape{1, kAnchors, 1}) scores = output;
  }
  if (boxes < 0 || scores < 0 || graph.shape(graph.input) != Shape{1, kSide_px, kSide_px, 3})
    return fail("it is not the network that finds people");
  keep_outputs(graph, {boxes, scores});
  fold_pads(graph);
  DANCE_TRY(auto made, make_engine(engine, graph));
  return PersonDetector(std::move(made));
}

void PersonDetector::decode(float least_score) {
  constexpr float kSize = kSide_px;
  const std::span<const float> boxes = engine_->output(0), scores = engine_->output(1);
  candidates_.clear();
  for (std::size_t i = 0; i < kAnchors; ++i) {
    const float score = 1.0f / (1.0f + std::exp(-std::clamp(scores[i], -100.0f, 100.0f)));
    if (!(score >= least_score)) continue;
    const float* raw = boxes.data() + i * kNumbers;
    if (!std::all_of(raw, raw + kNumbers, [](float value) { return std::isfinite(value); }))
      continue;
    Candidate candidate;
    candidate.score = score;
    const float x = raw[0] / kSize + anchors_[i][0], y = raw[1] / kSize + anchors_[i][1];
    const float width = raw[2] / kSize, height = raw[3] / kSize;
    candidate.at = {x - 0.5f * width, y - 0.5f * height, x + 0.5f * width, y + 0.5f * height};
    for (std::size_t k = kBoxNumbers; k < kNumbers; ++k)
      candidate.at[k] = raw[k] / kSize + anchors_[i][k % 2];
    candidates_.push_back(candidate);
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
}

// Those that mean the same person as the first one left, weighed by their scores; they are no
// longer there afterwards.
PersonDetector::Candidate PersonDetector::merge(std::size_t first) {
  const Candidate best = candidates_[first];
  Candidate merged = best;
  merged.at.fill(0.0f);
  float total = 0.0f;
  std::size_t kept = first;
  for (std::size_t i = first; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    if (i != first && overlap(candidate.at.data(), best.at.data()) <= kLeastOverlap) {
      candidates_[kept++] = candidate;
      continue;
    }
    total += candidate.score;
    for (std::size_t k = 0; k < kNumbers; ++k) merged.at[k] += candidate.score * candidate.at[k];
  }
  candidates_.resize(kept);
  for (float& value : merged.at) value /= total;
  return merged;
}

std::span<const SeenPerson> PersonDetector::find(const cv::Mat& picture, float least_score) {
  const auto width = static_cast<float>(picture.cols), height = static_cast<float>(picture.rows);
  // The whole picture in a square, black bars beside it.
  const BodyRegion whole{0.5f * width, 0.5f * height, std::max(width, height), 0.0f};
  sample_region(picture, whole, kSide_px, Beyond::kBlack, -1.0f, 1.0f, engine_->input());
  if (!engine_->run()) return {};
  decode(least_score);
  std::size_t people = 0;
  while (!candidates_.empty() && people < kMostPeople) {
    const Candidate candidate = merge(0);
    const auto point = [&](std::size_t number) {
      const std::size_t k = kBoxNumbers + 2 * number;
      return Eigen::Vector2f(whole.centre_x_px + (candidate.at[k] - 0.5f) * whole.side_px,
                             whole.centre_y_px + (candidate.at[k + 1] - 0.5f) * whole.side_px);
    };
    people_[people++] = {candidate.score, region_of(point(0), point(1))};
  }
  return {people_.data(), people};
}

}  // namespace dance
