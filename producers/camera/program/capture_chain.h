// CaptureChain: the pipeline from a picture to a pose on the bus: pose network, stereo depth where
// there are two cameras, solver, sink. One call a picture, in one thread, without queues.
//
// Units/frames: poses in W; latencies from the moment the picture was in hand, before it was
//               decoded, to the moment its pose was published.
// Ownership:    owns estimator, solver and stereo; refers to the sink, which must outlive it.
// Threads:      none inside; one owner.
// Failure:      a picture without a dancer gives no pose, and is counted.
#pragma once

#include <memory>
#include <optional>

#include "core/base/guest_id.h"
#include "core/base/histogram.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/frame.h"
#include "producers/camera/program/other_cameras.h"
#include "producers/camera/solver/body_solver.h"
#include "producers/camera/stereo/stereo_depth.h"
#include "producers/capture_sink.h"

namespace dance {

struct CaptureStats {
  std::uint64_t pictures = 0;
  std::uint64_t seen = 0;       // with a dancer in them
  std::uint64_t published = 0;  // poses
  Histogram dequeued_to_published;
  Histogram captured_to_published;
};

class CaptureChain {
 public:
  CaptureChain(const GuestId& guest, CaptureSink& sink, std::unique_ptr<PoseEstimator> estimator,
               std::unique_ptr<BodySolver> solver);
  // Further cameras, which must outlive it.
  void enable_others(OtherCameras& others) { others_ = &others; }
  void enable_stereo(std::unique_ptr<StereoDepth> stereo) { stereo_ = std::move(stereo); }

  // `right` is the other camera's picture of the same moment, or null.
  void see(const Frame& frame, const cv::Mat* right = nullptr);
  // Another solver, as pictures have another size.
  void use(std::unique_ptr<BodySolver> solver) { solver_ = std::move(solver); }
  // The camera was unplugged: the next picture is searched for the dancer.
  void restart();

  // What the network saw in the last picture.
  const BodyLandmarks& body() const { return *body_; }
  const CaptureStats& stats() const { return stats_; }
  const PoseEstimator& estimator() const { return *estimator_; }
  const BodySolver& solver() const { return *solver_; }
  const StereoDepth* stereo() const { return stereo_.get(); }

 private:
  void say_skeleton(MonoTime now);

  GuestId guest_;
  CaptureSink& sink_;
  std::unique_ptr<PoseEstimator> estimator_;
  std::unique_ptr<BodySolver> solver_;
  std::unique_ptr<StereoDepth> stereo_;
  OtherCameras* others_ = nullptr;
  const BodyLandmarks* body_;  // the estimator's
  CaptureStats stats_;
  std::uint32_t next_sequence_;
  std::uint32_t said_version_ = 0;
  MonoTime next_skeleton_;
  MonoTime last_seen_;
};

}  // namespace dance
