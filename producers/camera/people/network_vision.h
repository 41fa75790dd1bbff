// NetworkVision: PeopleVision by the networks that see one dancer, run over one picture after
// another region.
//
// Units/frames: as producers/camera/people/people_vision.h says.
// Ownership:    owns networks and memory; refers to the picture of look_at() until the next.
// Threads:      one owner; computes on the caller's thread alone.
// Failure:      open() names the file that is missing or damaged, and the cure.
#pragma once

#include <memory>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/people/body_mask.h"
#include "producers/camera/people/people_vision.h"

namespace dance {

class NetworkVision final : public PeopleVision {
 public:
  static Result<std::unique_ptr<NetworkVision>> open(const EstimatorOptions& options);
  // Three bytes a pixel.
  void look_at(const cv::Mat& blue_green_red) { picture_ = blue_green_red; }

  std::span<const SeenPerson> find(std::span<const SeenBody* const> without) override;
  bool read(const BodyRegion& region, const OtherPeople& others, ReadBody& out) override;
  std::optional<PictureColour> colour(const Eigen::Vector2f& place_px) override;

 private:
  NetworkVision(PersonDetector detector, LandmarkNetwork network, float least_score)
      : detector_(std::move(detector)), network_(std::move(network)), least_score_(least_score) {}

  PersonDetector detector_;
  LandmarkNetwork network_;
  float least_score_;
  cv::Mat picture_;
  BodyMask mask_;
};

}  // namespace dance
