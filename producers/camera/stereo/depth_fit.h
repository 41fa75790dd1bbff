// Estimates a body's distance and size from samples, some with a measured depth.
//
// Units/frames: metres in C of producers/camera/pinhole.h; the network's metres times `scale` are
//               true ones.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      nullopt where there are too few samples, or the result lies behind the camera.
// Source:       translation-only least squares; Tukey's biweight, iterated (Holland and Welsch,
//               1977).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "producers/camera/depth_hint.h"
#include "producers/camera/stereo/body_samples.h"

namespace dance {

// One camera: where the hips are if the network's metres are true ones.
struct MonocularFit {
  Eigen::Vector3d p_CH_m;
  double depth_spread_m = 0.0;
};
std::optional<MonocularFit> fit_monocular(const BodySamples& samples);

// A sample whose skin was found by both cameras.
struct SampleDepth {
  std::size_t sample = 0;
  double skin_depth_m = 0.0;
  double spread_m = 0.0;  // of the matching alone
};
// Two cameras, whose disparity is focal_baseline_px_m over the depth: joints is at least
// kLeastJoints.
constexpr int kLeastJoints = 4;
std::optional<DepthHint> fit_depth(const BodySamples& samples, std::span<const SampleDepth> depths,
                                   const MonocularFit& one_eye, double focal_baseline_px_m);

}  // namespace dance
