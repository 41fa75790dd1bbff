// PersonDetector: finds people in a whole picture: where their hips are, how large they are and how
// they are turned.
//
// Units/frames: pixels of the whole picture as producers/camera/region/picture_region.h has
//               them.
// Ownership:    owns its network and its memory; after make() it allocates nothing of its own.
// Threads:      one owner.
// Failure:      make() gives an Error; where the network fails to run nobody is found.
// Source:       BlazePose (Bazarevsky et al. 2020) and its model pose_detection.tflite: anchors,
//               decoding, weighted suppression.
#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>

#include "producers/camera/estimator/anchor_boxes.h"
#include "producers/camera/estimator/pose_engine.h"
#include "producers/camera/region/picture_region.h"

namespace dance {

struct SeenPerson {
  float score = 0.0f;  // 0…1
  BodyRegion region;
};

class PersonDetector {
 public:
  static constexpr int kSide_px = 224;
  static constexpr std::size_t kMostPeople = 8;

  static Result<PersonDetector> make(EngineKind engine, PoseGraph graph);

  // Those with at least the score, the surest first; good until the next call.
  std::span<const SeenPerson> find(const cv::Mat& blue_green_red, float least_score);
  // The same in two steps: what the network is to see, the picture in a square, may be changed in
  // between.
  const BodyRegion& look(const cv::Mat& blue_green_red);
  std::span<float> input() { return engine_->input(); }
  std::span<const SeenPerson> find_looked(float least_score);

 private:
  static constexpr std::size_t kAnchors = 2254;
  static constexpr std::size_t kNumbers = 12;  // an anchor regresses: a box, and four points

  explicit PersonDetector(std::unique_ptr<PoseEngine> engine);

  std::unique_ptr<PoseEngine> engine_;
  AnchorBoxes boxes_;
  BodyRegion whole_;  // of the picture that is looked at
  std::array<SeenPerson, kMostPeople> people_;
};

}  // namespace dance
