// PoseEstimator: from pictures to the points of one dancer's body. It searches the whole picture
// for a person, tracks that person from picture to picture, and searches again after a loss.
//
// Units/frames: as producers/camera/body_landmarks.h says; times are those of the frames.
// Ownership:    owns networks and memory. What estimate() returns is good until the next call.
// Threads:      one owner; computes on the caller's thread alone.
// Failure:      open() names the file that is missing or damaged, and the cure. A picture without a
//               person, a black one or one of another pixel format has found == false. In one call
//               it runs each network at most once.
// Source:       the order of steps: BlazePose (Bazarevsky et al. 2020) and MediaPipe's graph of
//               pose landmarks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/result.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/estimator/body_smoothing.h"
#include "producers/camera/estimator/identity_switch_detector.h"
#include "producers/camera/estimator/landmark_network.h"
#include "producers/camera/estimator/model_files.h"
#include "producers/camera/estimator/person_detector.h"
#include "producers/camera/estimator/target_tracker.h"
#include "producers/camera/frame.h"

namespace dance {

struct EstimatorOptions {
  PoseNetworkModel model = PoseNetworkModel::kFull;
  EngineKind engine = EngineKind::kFastest;
  std::string models_folder;  // "": pose_models_folder()
  bool smooths = true;        // what estimate() returns; unfiltered() never is
  bool tracks = true;         // false: each picture for itself
  float least_score = 0.5f;   // of a person whom the detector sees
  float least_presence = 0.5f;
  FollowOptions follow;
  // After so long without a person it searches only at this interval, by the frames' times.
  Duration search_eagerly = Duration::s(2);
  Duration search_interval = Duration::ms(100);
  // If given, what stages cost is added up with it.
  std::int64_t (*clock_ns)() = nullptr;
};

struct EstimatorCounters {
  std::uint64_t pictures = 0;
  std::uint64_t found = 0;
  std::uint64_t searches = 0;   // of the whole picture, without a target
  std::uint64_t looks = 0;      // of the whole picture during tracking, for identity switches
  std::uint64_t losses = 0;     // of the target
  std::uint64_t refused = 0;    // of these: the body jumped farther than a body can
  std::uint64_t exchanged = 0;  // identity switches that were detected and corrected
  std::uint64_t unusable = 0;   // no picture of three bytes a pixel, or the network refused
};

struct EstimatorTimes {
  std::int64_t search_ns = 0;
  std::int64_t region_ns = 0;  // taking the region out of the picture
  std::int64_t network_ns = 0;
  std::int64_t rest_ns = 0;
};

// Detector and landmark network, as the options name them.
struct PoseNetworks {
  PersonDetector detector;
  LandmarkNetwork landmarks;
};
Result<PoseNetworks> open_networks(const EstimatorOptions& options);

class PoseEstimator {
 public:
  static Result<std::unique_ptr<PoseEstimator>> open(const EstimatorOptions& options);

  const BodyLandmarks& estimate(const Frame& frame);
  // The same picture's, before smoothing.
  const BodyLandmarks& unfiltered() const { return unfiltered_; }

  // Drops the target; the next picture is searched.
  void reset();
  // The next picture is searched, and from now on the person nearest to this place is tracked.
  void follow(float x_px, float y_px);

  const EstimatorCounters& counters() const { return counters_; }
  const EstimatorTimes& times() const { return times_; }
  LandmarkNetwork& network() { return network_; }

 private:
  PoseEstimator(const EstimatorOptions& options, PersonDetector detector, LandmarkNetwork network);
  bool is_due_to_search(MonoTime now) const;
  std::optional<BodyRegion> search(const Frame& frame);
  void lose(MonoTime now);
  // True where the body in `seen` is not the target; the next picture tracks the target again.
  bool is_exchanged(const Frame& frame, const BodyRegion& seen);
  std::int64_t clock_ns() const { return options_.clock_ns ? options_.clock_ns() : 0; }

  EstimatorOptions options_;
  PersonDetector detector_;
  LandmarkNetwork network_;
  BodySmoothing smoothing_;
  TargetTracker target_;
  IdentitySwitchDetector switch_detector_;
  std::optional<BodyRegion> next_region_;  // while there is a target
  bool is_exchanged_ = false;              // it belongs to another person than the last picture's
  std::optional<MonoTime> nobody_since_, last_search_;
  cv::Size picture_size_;
  SeenBody body_;
  BodyLandmarks result_, unfiltered_;
  EstimatorCounters counters_;
  EstimatorTimes times_;
};

}  // namespace dance
