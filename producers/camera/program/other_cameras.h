// OtherCameras: the cameras of --also: each has a thread with its own pose network, and what that
// saw goes to the first camera's thread, which places the cameras and hands their views to the
// solver. A picture of the first camera waits for none of them.
//
// Units/frames: as producers/camera/multiview/multi_view.h.
// Ownership:    owns sources, networks and threads.
// Threads:      one for each camera, from start() on; all calls are of the first camera's thread.
// Failure:      open() names the camera, the reason and the cure. A camera that is unplugged later,
//               or gives pictures of another size, is left out and told once.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/result.h"
#include "core/base/spsc_ring.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/frame_source.h"
#include "producers/camera/multiview/multi_view.h"
#include "producers/camera/program/capture_options.h"
#include "producers/camera/solver/body_solver.h"

namespace dance {

// A picture's body between two threads.
struct SentBody {
  std::int64_t time_ns = 0;
  float side_px = 0.0f;
  bool is_new = false;
  std::array<float, 2 * kLandmarkCount> image_px{};
  std::array<float, 3 * kLandmarkCount> world_m{};
  std::array<float, kLandmarkCount> visibility{};
};

// What is known of one of them, for reports.
struct OtherCameraReport {
  std::string name;
  std::uint64_t pictures = 0;
  std::uint64_t seen = 0;  // with a dancer in them
  std::optional<PairPlacement> placement;
  int moves = 0;
};

class OtherCameras {
 public:
  static Result<std::unique_ptr<OtherCameras>> open(const CaptureOptions& options,
                                                    const Pinhole& first);
  ~OtherCameras();

  // Once signals are blocked.
  void start();
  // What they saw of the dancer at this picture of the first camera; tells the solver the lengths
  // that were measured. Good until the next call.
  OtherViews see_first(const BodyLandmarks& body, BodySolver& solver);
  // The first camera's pictures have another size.
  void set_first(const Pinhole& first) { views_.set_first(first); }
  // Another dancer: the placement stays, lengths are measured again.
  void reset_body() { views_.reset_body(); }

  // What changed since the last call, one line a call; "" where nothing did.
  std::string news();
  std::vector<OtherCameraReport> reports() const;

 private:
  struct Camera {
    std::string name;
    std::unique_ptr<FrameSource> source;
    std::unique_ptr<PoseEstimator> estimator;
    SpscRing<SentBody, 64> bodies;
    std::atomic<std::uint64_t> pictures{0}, seen{0};
    std::atomic<bool> is_gone{false}, is_over{false}, has_other_size{false}, stop{false};
    std::thread thread;
    // Of what news() told.
    bool has_told_search = false, has_told_gone = false, has_told_size = false,
         has_told_over = false;
    bool was_placed = false;
    int told_moves = 0;
  };
  explicit OtherCameras(const Pinhole& first) : views_(first) {}
  static void run(Camera& camera);

  MultiView views_;
  std::optional<double> told_height_m_;
  std::vector<std::unique_ptr<Camera>> cameras_;
};

// "2.1 m to the left, 0.4 m further back, turned 55 degrees, its pictures 12 ms late".
std::string text_of(const PairPlacement& placement);

}  // namespace dance
