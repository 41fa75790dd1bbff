#include "producers/camera/hands/hand_network.h"

#include <filesystem>

#include "producers/camera/estimator/tflite_file.h"
#include "producers/camera/hands/hand_region.h"
#include "producers/camera/region/picture_region.h"
#include "producers/camera/region/region_sampler.h"

namespace dance {
namespace {

constexpr int kRecropSide_px = 256, kHandSide_px = 224;
constexpr float kLeastPresence = 0.5f;
// The scale in which the network was taught depth.
constexpr float kDepthScale = 0.4f;

constexpr const char* kRecrop = "/hand_recrop.tflite";
constexpr const char* kLandmarks = "/hand_landmark_full.tflite";

}  // namespace

bool HandNetworks::are_in(const std::string& folder) {
  return std::filesystem::exists(folder + kRecrop) && std::filesystem::exists(folder + kLandmarks);
}

Result<HandNetworks> HandNetworks::open(EngineKind engine, const std::string& folder) {
  DANCE_TRY(PoseGraph where, read_tflite_file(folder + kRecrop));
  DANCE_TRY(PoseGraph points, read_tflite_file(folder + kLandmarks));
  return make(engine, std::move(where), std::move(points));
}

Result<HandNetworks> HandNetworks::make(EngineKind engine, PoseGraph recrop, PoseGraph landmarks) {
  if (recrop.shape(recrop.input) != Shape{1, kRecropSide_px, kRecropSide_px, 3} ||
      recrop.outputs.size() != 1 || elements_of(recrop.shape(recrop.outputs[0])) != 4)
    return fail("hand_recrop.tflite is not a network that says where a hand is");
  // Points, presence, which hand it is, metres.
  const std::size_t due[] = {3 * kHandPointCount, 1, 1, 3 * kHandPointCount};
  bool fits = landmarks.shape(landmarks.input) == Shape{1, kHandSide_px, kHandSide_px, 3} &&
              landmarks.outputs.size() == std::size(due);
  for (std::size_t i = 0; fits && i < std::size(due); ++i)
    fits = elements_of(landmarks.shape(landmarks.outputs[i])) == due[i];
  if (!fits) return fail("hand_landmark_full.tflite is not a network that finds a hand's points");
  // Which hand it is follows from the body.
  keep_outputs(landmarks, {landmarks.outputs[0], landmarks.outputs[1], landmarks.outputs[3]});
  fold_pads(recrop);
  fold_pads(landmarks);
  DANCE_TRY(auto where, make_engine(engine, recrop));
  DANCE_TRY(auto points, make_engine(engine, landmarks));
  return HandNetworks(std::move(where), std::move(points));
}

std::optional<BodyRegion> HandNetworks::recrop(const cv::Mat& picture, const BodyRegion& searched) {
  sample_region(picture, searched, kRecropSide_px, Beyond::kNearest, 0.0f, 1.0f, recrop_->input());
  if (!recrop_->run() || !all_finite(recrop_->output(0))) return std::nullopt;
  constexpr auto kSide = static_cast<float>(kRecropSide_px);
  const std::span<const float> n = recrop_->output(0);
  const BodyRegion region = hand_region_between(searched, Eigen::Vector2f(n[0], n[1]) / kSide,
                                                Eigen::Vector2f(n[2], n[3]) / kSide);
  if (!is_usable(region, searched)) return std::nullopt;
  return region;
}

bool HandNetworks::look(const cv::Mat& picture, const BodyRegion& region, HandLandmarks& out) {
  out.found = false;
  sample_region(picture, region, kHandSide_px, Beyond::kNearest, 0.0f, 1.0f, landmarks_->input());
  if (!landmarks_->run()) return false;
  const std::span<const float> points = landmarks_->output(0), world = landmarks_->output(2);
  out.presence = landmarks_->output(1)[0];
  if (!all_finite(points) || !all_finite(world) || !(out.presence > kLeastPresence)) return false;
  out.region = region;
  constexpr auto kSide = static_cast<float>(kHandSide_px);
  read_points(region, points, kSide, kSide * kDepthScale, out.image_px);
  const RegionFrame frame(region);
  for (std::size_t i = 0; i < kHandPointCount; ++i) {
    const float* w = world.data() + 3 * i;
    const Eigen::Vector2f across = frame.turned({w[0], w[1]});
    out.world_m[i] = {across.x(), across.y(), w[2]};
  }
  out.found = true;
  return true;
}

}  // namespace dance
