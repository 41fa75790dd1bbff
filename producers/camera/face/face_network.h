// FaceNetworks: the two networks of a face: one that finds it where the body says that it is, and
// one that finds its 468 points.
//
// Units/frames: as producers/camera/face/face_landmarks.h says.
// Ownership:    owns its networks and their memory; after make() it allocates nothing of its own.
// Threads:      one owner.
// Failure:      make() gives an Error. The others give nothing where a network refuses to run or
//               makes what is no number.
// Source:       BlazeFace (Bazarevsky et al. 2019), the models face_detection_short_range.tflite
//               and face_landmark.tflite, and what belongs to their numbers in the graphs of
//               @mediapipe/holistic 0.5.1675471629.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "producers/camera/estimator/anchor_boxes.h"
#include "producers/camera/estimator/pose_engine.h"
#include "producers/camera/face/face_landmarks.h"

namespace cv {
class Mat;
}

namespace dance {

class FaceNetworks {
 public:
  // Of the folder of the networks: pose_models_folder(). The Error names what is missing or
  // damaged, and the cure.
  static Result<FaceNetworks> open(EngineKind engine, const std::string& folder);
  static bool are_in(const std::string& folder);
  static Result<FaceNetworks> make(EngineKind engine, PoseGraph detector, PoseGraph landmarks);

  // Where in `searched` the face is, as the region that shows it best.
  std::optional<BodyRegion> find(const cv::Mat& blue_green_red, const BodyRegion& searched);
  // Its points in this region; `found` says whether there is a face.
  bool look(const cv::Mat& blue_green_red, const BodyRegion& region, FaceLandmarks& out);

 private:
  static constexpr std::size_t kNumbers = 16;  // a box, and six points

  FaceNetworks(std::unique_ptr<PoseEngine> detector, std::unique_ptr<PoseEngine> landmarks);

  std::unique_ptr<PoseEngine> detector_, landmarks_;
  AnchorBoxes faces_;
};

}  // namespace dance
