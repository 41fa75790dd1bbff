#include "producers/camera/face/face_network.h"

#include <filesystem>

#include "producers/camera/estimator/tflite_file.h"
#include "producers/camera/face/face_region.h"
#include "producers/camera/region/picture_region.h"
#include "producers/camera/region/region_sampler.h"

namespace dance {

using Eigen::Vector2f;

namespace {

constexpr const char* kFaceDetector = "/face_detection_short_range.tflite";
constexpr const char* kFaceLandmarks = "/face_landmark.tflite";
constexpr int kDetectorSide_px = 128, kFaceSide_px = 192;
constexpr int kAnchorCount = 896;
constexpr float kLeastScore = 0.5f, kLeastPresence = 0.5f;
constexpr AnchorGrid kGrids[] = {{16, 2}, {8, 6}};

}  // namespace

FaceNetworks::FaceNetworks(std::unique_ptr<PoseEngine> detector,
                           std::unique_ptr<PoseEngine> landmarks)
    : detector_(std::move(detector)),
      landmarks_(std::move(landmarks)),
      faces_(kGrids, kNumbers, kDetectorSide_px) {}

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

std::optional<BodyRegion> FaceNetworks::find(const cv::Mat& picture, const BodyRegion& searched) {
  sample_region(picture, searched, kDetectorSide_px, Beyond::kBlack, -1.0f, 1.0f,
                detector_->input());
  if (!detector_->run()) return std::nullopt;
  faces_.decode(detector_->output(0), detector_->output(1), kLeastScore);
  if (faces_.is_empty()) return std::nullopt;
  const AnchorBox face = faces_.take_surest();
  std::array<Vector2f, kDetectedFacePoints> points;
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = face.point(i);
  const BodyRegion region = face_region_of_points(searched, points);
  if (!is_usable(region, searched)) return std::nullopt;
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
  read_points(region, points, kSide, kSide, out.image_px);
  out.found = true;
  return true;
}

}  // namespace dance
