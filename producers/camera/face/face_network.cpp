#include "producers/camera/face/face_network.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "producers/camera/estimator/region_sampler.h"
#include "producers/camera/estimator/tflite_file.h"
#include "producers/camera/face/face_region.h"

namespace dance {

using Eigen::Vector2f;

namespace {

constexpr const char* kFaceDetector = "/face_detection_short_range.tflite";
constexpr const char* kFaceLandmarks = "/face_landmark.tflite";
constexpr int kDetectorSide_px = 128, kFaceSide_px = 192;
constexpr int kAnchorCount = 896;
constexpr float kLeastScore = 0.5f, kLeastPresence = 0.5f, kLeastOverlap = 0.3f;
constexpr float kMostRaw = 100.0f;

struct AnchorGrid {
  int cells, anchors;
};
constexpr AnchorGrid kGrids[] = {{16, 2}, {8, 6}};

bool all_finite(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
}

float sigmoid(float x) { return 1.0f / (1.0f + std::exp(-x)); }

float overlap(const float* a, const float* b) {
  const float width = std::min(a[2], b[2]) - std::max(a[0], b[0]);
  const float height = std::min(a[3], b[3]) - std::max(a[1], b[1]);
  if (width <= 0.0f || height <= 0.0f) return 0.0f;
  const float both = width * height;
  const float either = (a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both;
  return either > 0.0f ? both / either : 0.0f;
}

}  // namespace

FaceNetworks::FaceNetworks(std::unique_ptr<PoseEngine> detector,
                           std::unique_ptr<PoseEngine> landmarks)
    : detector_(std::move(detector)), landmarks_(std::move(landmarks)) {
  for (const AnchorGrid& grid : kGrids)
    for (int y = 0; y < grid.cells; ++y)
      for (int x = 0; x < grid.cells; ++x)
        for (int i = 0; i < grid.anchors; ++i)
          anchors_.push_back({(static_cast<float>(x) + 0.5f) / static_cast<float>(grid.cells),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(grid.cells)});
  candidates_.reserve(anchors_.size());
}

bool FaceNetworks::are_in(const std::string& folder) {
  return std::filesystem::exists(folder + kFaceDetector) &&
         std::filesystem::exists(folder + kFaceLandmarks);
}

Result<FaceNetworks> FaceNetworks::open(EngineKind engine, const std::string& folder) {
  DANCE_TRY(PoseGraph detector, read_tflite_file(folder + kFaceDetector));
  DANCE_TRY(PoseGraph points, read_tflite_file(folder + kFaceLandmarks));
  return make(engine, std::move(detector), std::move(points));
}

Result<FaceNetworks> FaceNetworks::make(EngineKind engine, PoseGraph detector, PoseGraph points) {
  const auto has_outputs = [](const PoseGraph& graph, std::size_t first, std::size_t second) {
    return graph.outputs.size() == 2 && elements_of(graph.shape(graph.outputs[0])) == first &&
           elements_of(graph.shape(graph.outputs[1])) == second;
  };
  if (detector.shape(detector.input) != Shape{1, kDetectorSide_px, kDetectorSide_px, 3} ||
      !has_outputs(detector, kAnchorCount * kNumbers, kAnchorCount))
    return fail("face_detection_short_range.tflite is not a network that finds faces");
  if (points.shape(points.input) != Shape{1, kFaceSide_px, kFaceSide_px, 3} ||
      !has_outputs(points, 3 * kFacePointCount, 1))
    return fail("face_landmark.tflite is not a network that finds a face's points");
  fold_pads(detector);
  fold_pads(points);
  DANCE_TRY(auto where, make_engine(engine, detector));
  DANCE_TRY(auto what, make_engine(engine, points));
  return FaceNetworks(std::move(where), std::move(what));
}

std::optional<FaceNetworks::Candidate> FaceNetworks::surest() {
  candidates_.clear();
  const std::span<const float> boxes = detector_->output(0), scores = detector_->output(1);
  constexpr auto kSide = static_cast<float>(kDetectorSide_px);
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const float score = sigmoid(std::clamp(scores[i], -kMostRaw, kMostRaw));
    const float* raw = boxes.data() + i * kNumbers;
    if (!(score >= kLeastScore) || !all_finite({raw, kNumbers})) continue;
    Candidate& c = candidates_.emplace_back();
    c.score = score;
    const float x = raw[0] / kSide + anchors_[i][0], y = raw[1] / kSide + anchors_[i][1];
    const float half_width = 0.5f * raw[2] / kSide, half_height = 0.5f * raw[3] / kSide;
    c.at = {x - half_width, y - half_height, x + half_width, y + half_height};
    for (std::size_t k = 4; k < kNumbers; ++k) c.at[k] = raw[k] / kSide + anchors_[i][k % 2];
  }
  if (candidates_.empty()) return std::nullopt;
  const Candidate best =
      *std::max_element(candidates_.begin(), candidates_.end(),
                        [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  Candidate merged = best;
  merged.at.fill(0.0f);
  float total = 0.0f;
  for (const Candidate& c : candidates_) {
    if (overlap(c.at.data(), best.at.data()) <= kLeastOverlap) continue;
    total += c.score;
    for (std::size_t k = 0; k < kNumbers; ++k) merged.at[k] += c.score * c.at[k];
  }
  if (!(total > 0.0f)) return best;
  for (float& number : merged.at) number /= total;
  return merged;
}

std::optional<BodyRegion> FaceNetworks::find(const cv::Mat& picture, const BodyRegion& searched) {
  sample_region(picture, searched, kDetectorSide_px, Beyond::kBlack, -1.0f, 1.0f,
                detector_->input());
  if (!detector_->run()) return std::nullopt;
  const std::optional<Candidate> face = surest();
  if (!face) return std::nullopt;
  std::array<Vector2f, kDetectedFacePoints> points;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {face->at[4 + 2 * i], face->at[5 + 2 * i]};
  const BodyRegion region = face_region_of_points(searched, points);
  if (!(region.side_px >= 1.0f) || region.side_px > 100.0f * searched.side_px) return std::nullopt;
  return region;
}

bool FaceNetworks::look(const cv::Mat& picture, const BodyRegion& region, FaceLandmarks& out) {
  out.found = false;
  sample_region(picture, region, kFaceSide_px, Beyond::kNearest, 0.0f, 1.0f, landmarks_->input());
  if (!landmarks_->run()) return false;
  const std::span<const float> points = landmarks_->output(0);
  out.presence = sigmoid(landmarks_->output(1)[0]);
  if (!all_finite(points) || !(out.presence > kLeastPresence)) return false;
  out.region = region;
  constexpr auto kSide = static_cast<float>(kFaceSide_px);
  const float c = std::cos(region.turn_rad), s = std::sin(region.turn_rad);
  for (std::size_t i = 0; i < kFacePointCount; ++i) {
    const float* n = points.data() + 3 * i;
    const float x = n[0] / kSide - 0.5f, y = n[1] / kSide - 0.5f;
    out.image_px[i] = {region.centre_x_px + region.side_px * (c * x - s * y),
                       region.centre_y_px + region.side_px * (s * x + c * y),
                       region.side_px * n[2] / kSide};
  }
  out.found = true;
  return true;
}

}  // namespace dance
