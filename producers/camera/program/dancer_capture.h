// DancerCapture: one dancer before the camera: from the network's points to poses on the bus.
//
// Units/frames: poses in W; latencies from the moment the picture was in hand, before it was
//               decoded, to the moment its pose was published.
// Ownership:    owns solver, stereo, hands and face; refers to the sink, which must outlive it.
// Threads:      none inside; one owner.
// Failure:      a picture without the dancer gives no pose, and is counted.
#pragma once

#include <memory>
#include <optional>

#include "core/base/guest_id.h"
#include "core/base/histogram.h"
#include "producers/camera/extras/hands_and_face.h"
#include "producers/camera/frame.h"
#include "producers/camera/program/other_cameras.h"
#include "producers/camera/solver/body_solver.h"
#include "producers/camera/stereo/stereo_depth.h"
#include "producers/capture_sink.h"

namespace dance {

struct DancerStats {
  std::uint64_t seen = 0;       // pictures with this dancer in them
  std::uint64_t published = 0;  // poses
  Histogram dequeued_to_published;
  Histogram captured_to_published;
};

class DancerCapture {
 public:
  // Wants a solver before the first picture: use().
  DancerCapture(const GuestId& guest, CaptureSink& sink);
  // Further cameras, which must outlive it.
  void enable_others(OtherCameras& others) { others_ = &others; }
  void enable_stereo(std::unique_ptr<StereoDepth> stereo) { stereo_ = std::move(stereo); }
  void enable_extras(std::unique_ptr<HandsAndFace> extras) { extras_ = std::move(extras); }

  // `right` is the other camera's picture of the same moment, or null.
  void publish(const Frame& frame, const BodyLandmarks& seen, const cv::Mat* right);
  // Hands and face, after the poses of all dancers.
  void look_closer(const Frame& frame, const BodyLandmarks& seen);

  // The solver for pictures of this size.
  void use(std::unique_ptr<BodySolver> solver) { solver_ = std::move(solver); }
  void restart();

  const GuestId& guest() const { return guest_; }
  const DancerStats& stats() const { return stats_; }
  const BodySolver& solver() const { return *solver_; }
  const StereoDepth* stereo() const { return stereo_.get(); }

 private:
  void see_again(MonoTime now);
  void say_skeleton(MonoTime now);

  GuestId guest_;
  CaptureSink& sink_;
  std::unique_ptr<BodySolver> solver_;
  std::unique_ptr<StereoDepth> stereo_;
  std::unique_ptr<HandsAndFace> extras_;
  OtherCameras* others_ = nullptr;
  DancerStats stats_;
  Pose pose_;                   // of the last picture
  bool has_published_ = false;  // in it
  std::uint32_t next_sequence_;
  std::uint32_t said_version_ = 0;
  MonoTime next_skeleton_;
  MonoTime last_seen_;
};

}  // namespace dance
