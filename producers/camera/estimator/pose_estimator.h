// PoseEstimator: from pictures to the points of one dancer's body. It searches the whole picture
// until it has somebody, follows that person from picture to picture, and searches again when the
// person is lost.
//
// Units/frames: as producers/camera/body_landmarks.h says; times are those of the frames.
// Ownership:    owns networks and memory. What estimate() returns is good until the next call.
// Threads:      one owner; computes on the caller's thread alone.
// Failure:      open() names the file that is missing or damaged, and the cure. A picture without
//               anybody, a black one or one that is no picture has found == false. In one call it
//               runs each network at most once.
// Source:       the order of steps: BlazePose (Bazarevsky et al. 2020) and MediaPipe's graph of
//               pose landmarks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/result.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/estimator/body_smoothing.h"
#include "producers/camera/estimator/landmark_network.h"
#include "producers/camera/estimator/model_files.h"
#include "producers/camera/estimator/people_watch.h"
#include "producers/camera/estimator/person_detector.h"
#include "producers/camera/estimator/person_memory.h"
#include "producers/camera/frame.h"

namespace dance {

struct EstimatorOptions {
  PoseModel model = PoseModel::kFull;
  EngineKind engine = EngineKind::kFastest;
  std::string models_folder;  // "": pose_models_folder()
  bool smooths = true;        // what estimate() returns; unfiltered() never is
  bool tracks = true;         // false: each picture for itself
  float least_score = 0.5f;   // of a person whom the detector sees
  float least_presence = 0.5f;
  FollowOptions follow;
  // Nobody for so long: from then on it searches only so often, by the frames' times.
  Duration search_eagerly = Duration::s(2);
  Duration search_interval = Duration::ms(100);
  // If given, what stages cost is added up with it.
  std::int64_t (*clock_ns)() = nullptr;
};

struct EstimatorCounters {
  std::uint64_t pictures = 0;
  std::uint64_t found = 0;
  std::uint64_t searches = 0;  // of the whole picture, while nobody is followed
  std::uint64_t looks = 0;     // at the whole picture, while somebody is: for others who cross
  std::uint64_t losses = 0;    // of somebody who was followed
  std::uint64_t refused = 0;   // of these: the body jumped farther than a body can
  std::uint64_t exchanged =
      0;  // the one who is followed was taken for somebody who crossed, and is followed again
  std::uint64_t unusable = 0;  // no picture of three bytes a pixel, or the network refused
};

struct EstimatorTimes {
  std::int64_t search_ns = 0;
  std::int64_t region_ns = 0;  // taking the region out of the picture
  std::int64_t network_ns = 0;
  std::int64_t rest_ns = 0;
};

class PoseEstimator {
 public:
  static Result<std::unique_ptr<PoseEstimator>> open(const EstimatorOptions& options);

  const BodyLandmarks& estimate(const Frame& frame);
  // The same picture's, before smoothing.
  const BodyLandmarks& unfiltered() const { return unfiltered_; }

  // The next picture is searched; nobody is remembered.
  void forget();
  // The next picture is searched, and from now on whoever is nearest to this place is followed.
  void follow(float x_px, float y_px);

  const EstimatorCounters& counters() const { return counters_; }
  const EstimatorTimes& times() const { return times_; }
  LandmarkNetwork& network() { return network_; }

 private:
  PoseEstimator(const EstimatorOptions& options, PersonDetector detector, LandmarkNetwork network);
  bool is_due_to_search(MonoTime now) const;
  std::optional<BodyRegion> search(const Frame& frame);
  void lose(MonoTime now);
  // True where the body in `seen` is not the one who is followed; the next picture is that one's.
  bool is_exchanged(const Frame& frame, const BodyRegion& seen);
  static void fill(const SeenBody& body, BodyLandmarks& out);
  std::int64_t clock_ns() const { return options_.clock_ns ? options_.clock_ns() : 0; }

  EstimatorOptions options_;
  PersonDetector detector_;
  LandmarkNetwork network_;
  BodySmoothing smoothing_;
  PersonMemory memory_;
  PeopleWatch watch_;
  std::optional<BodyRegion> next_region_;  // while somebody is followed
  bool is_exchanged_ = false;              // it is somebody else's than the last picture's
  std::optional<MonoTime> nobody_since_, last_search_;
  cv::Size picture_size_;
  SeenBody body_;
  BodyLandmarks result_, unfiltered_;
  EstimatorCounters counters_;
  EstimatorTimes times_;
};

}  // namespace dance
