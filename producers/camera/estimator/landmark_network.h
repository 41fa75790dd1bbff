// LandmarkNetwork: the points of the body of one person, within the region where that person is.
//
// Units/frames: as producers/camera/body_landmarks.h says; pixels as
//               producers/camera/region/picture_region.h has them.
// Ownership:    owns its network and its memory; after make() it allocates nothing of its own.
// Threads:      one owner.
// Failure:      make() gives an Error. read() is false where the network refuses to run or makes
//               what is no number.
// Source:       BlazePose GHUM 3D: the models pose_landmark_{lite,full,heavy}.tflite and what
//               belongs to their numbers.
#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "producers/camera/estimator/pose_engine.h"
#include "producers/camera/region/picture_region.h"

namespace dance {

struct SeenBody {
  float presence = 0.0f;  // 0…1
  std::array<Eigen::Vector3f, kLandmarkCount> image_px;
  std::array<Eigen::Vector3f, kLandmarkCount> world_m;
  std::array<float, kLandmarkCount> visibility{};
  // Middle and edge of the region in which the body will be found next: region_of().
  std::array<Eigen::Vector2f, 2> next_px;

  Eigen::Vector2f place_px(Landmark l) const { return image_px[index_of(l)].head<2>(); }
  BodyRegion next_region() const { return region_of(next_px[0], next_px[1]); }
  // How large it is in the picture.
  float size_px() const { return 2.0f * (next_px[1] - next_px[0]).norm(); }
};
inline void write_points(const SeenBody& body, BodyLandmarks& out) {
  out.image_px = body.image_px;
  out.world_m = body.world_m;
  out.visibility = body.visibility;
}

class LandmarkNetwork {
 public:
  static constexpr int kSide_px = 256;

  static Result<LandmarkNetwork> make(EngineKind engine, PoseGraph graph);

  // To be called in this order; separate, so that each can be timed.
  void look(const cv::Mat& blue_green_red, const BodyRegion& region);
  bool run() { return engine_->run(); }
  bool read(SeenBody& out) const;

  // What the network gives, by its name in the model card.
  std::span<const float> landmark_numbers() const { return engine_->output(0); }
  std::span<const float> world_numbers() const { return engine_->output(3); }
  std::span<const float> heat() const { return engine_->output(2); }
  float presence() const { return engine_->output(1)[0]; }
  std::span<float> input() { return engine_->input(); }

 private:
  explicit LandmarkNetwork(std::unique_ptr<PoseEngine> engine) : engine_(std::move(engine)) {}
  Eigen::Vector2f refined(std::size_t point, const Eigen::Vector2f& coarse) const;

  std::unique_ptr<PoseEngine> engine_;
  BodyRegion region_;
};

}  // namespace dance
