// PersonDetector: finds people in a whole picture: where their hips are, how large they are and how
// they are turned.
//
// Units/frames: pixels of the whole picture as producers/camera/estimator/region_sampler.h has
//               them.
// Ownership:    owns its network and its memory; after make() it allocates nothing of its own.
// Threads:      one owner.
// Failure:      make() gives an Error; where the network fails to run nobody is found.
// Source:       BlazePose (Bazarevsky et al. 2020) and its model pose_detection.tflite: anchors,
//               decoding, weighted suppression.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "producers/camera/estimator/pose_engine.h"
#include "producers/camera/estimator/region_sampler.h"

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

 private:
  static constexpr std::size_t kAnchors = 2254;
  static constexpr std::size_t kNumbers = 12;  // an anchor regresses: a box, and four points

  struct Candidate {
    float score = 0.0f;
    std::array<float, kNumbers>
        at{};  // left, top, right, bottom, then x and y of points; 0…1 of the square
  };

  explicit PersonDetector(std::unique_ptr<PoseEngine> engine);
  void decode(float least_score);
  Candidate merge(std::size_t first);

  std::unique_ptr<PoseEngine> engine_;
  std::vector<std::array<float, 2>> anchors_;
  std::vector<Candidate> candidates_;
  std::array<SeenPerson, kMostPeople> people_;
};

}  // namespace dance
