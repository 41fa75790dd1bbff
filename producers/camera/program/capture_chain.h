// CaptureChain: the pipeline from a picture to the poses on the bus: pose network, then for each
// dancer solver and sink. One call a picture, in one thread, without queues.
//
// Units/frames: as its parts say.
// Ownership:    owns its parts.
// Threads:      none inside; one owner.
// Failure:      a picture without a dancer gives no pose, and is counted.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "producers/camera/program/dancer_capture.h"
#include "producers/camera/program/landmark_source.h"

namespace dance {

class CaptureChain {
 public:
  // As many dancers as the source sees.
  CaptureChain(std::unique_ptr<LandmarkSource> source,
               std::vector<std::unique_ptr<DancerCapture>> dancers);

  // `right` is the other camera's picture of the same moment, or null.
  void see(const Frame& frame, const cv::Mat* right = nullptr);
  // The camera was unplugged: the next picture is searched for the dancers.
  void restart();

  // What the network saw in the last picture, of each dancer.
  std::span<const BodyLandmarks> bodies() const { return bodies_; }
  std::span<const std::unique_ptr<DancerCapture>> dancers() const { return dancers_; }
  DancerCapture& first() const { return *dancers_.front(); }
  LandmarkSource& source() const { return *source_; }
  std::uint64_t pictures() const { return pictures_; }

 private:
  std::unique_ptr<LandmarkSource> source_;
  std::vector<std::unique_ptr<DancerCapture>> dancers_;
  std::span<const BodyLandmarks> bodies_;  // the source's
  std::uint64_t pictures_ = 0;
};

}  // namespace dance
