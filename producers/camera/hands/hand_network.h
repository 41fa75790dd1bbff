// HandNetworks: the two networks of a hand: one that says where in a region the hand is, and one
// that finds its 21 points.
//
// Units/frames: as producers/camera/hands/hand_landmarks.h says.
// Ownership:    owns its networks and their memory; after make() it allocates nothing of its own.
// Threads:      one owner.
// Failure:      make() gives an Error. The others give nothing where a network refuses to run or
//               makes what is no number.
// Source:       the models hand_recrop.tflite and hand_landmark_full.tflite, and what belongs to
//               their numbers in the graphs of @mediapipe/holistic.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "producers/camera/estimator/pose_engine.h"
#include "producers/camera/hands/hand_landmarks.h"

namespace cv {
class Mat;
}

namespace dance {

class HandNetworks {
 public:
  // Of the folder of the networks: pose_models_folder(). The Error names what is missing or
  // damaged, and the cure.
  static Result<HandNetworks> open(EngineKind engine, const std::string& folder);
  static bool are_in(const std::string& folder);
  static Result<HandNetworks> make(EngineKind engine, PoseGraph recrop, PoseGraph landmarks);

  // Where in `searched` the hand is, as the region that shows it best.
  std::optional<BodyRegion> recrop(const cv::Mat& blue_green_red, const BodyRegion& searched);
  // Its points in this region; `found` says whether there is a hand.
  bool look(const cv::Mat& blue_green_red, const BodyRegion& region, HandLandmarks& out);

 private:
  HandNetworks(std::unique_ptr<PoseEngine> recrop, std::unique_ptr<PoseEngine> landmarks)
      : recrop_(std::move(recrop)), landmarks_(std::move(landmarks)) {}

  std::unique_ptr<PoseEngine> recrop_, landmarks_;
};

}  // namespace dance
