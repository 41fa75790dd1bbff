// PoseEngine: runs a network on one picture. There are two: XNNPACK where it is built in, and
// OpenCV's own everywhere; both compute the same numbers up to rounding.
//
// Units/frames: input and outputs lie as producers/camera/estimator/pose_graph.h says, one batch:
//               rows, columns, channels.
// Ownership:    owns its memory; input() and output() stay where they are.
// Threads:      one owner; runs on the caller's thread alone.
// Failure:      making one gives an Error; run() is false where the engine refuses, and the outputs
//               are then not to be read. run() allocates nothing of ours.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_graph.h"

namespace dance {

class PoseEngine {
 public:
  virtual ~PoseEngine() = default;
  virtual std::span<float> input() = 0;
  virtual bool run() = 0;
  // Of the i-th of the graph's outputs.
  virtual std::span<const float> output(std::size_t i) const = 0;
};

enum class EngineKind { kFastest, kXnnpack, kOpenCv };
constexpr bool kHasXnnpack =
#ifdef DANCE_HAVE_XNNPACK
    true;
#else
    false;
#endif

// Of what a network gives.
inline float sigmoid(float x) { return 1.0f / (1.0f + std::exp(-x)); }
inline bool all_finite(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
}

// What kFastest stands for in this build.
EngineKind chosen_engine(EngineKind wished);
std::string_view name_of(EngineKind kind);

Result<std::unique_ptr<PoseEngine>> make_engine(EngineKind kind, const PoseGraph& graph);
Result<std::unique_ptr<PoseEngine>> make_opencv_engine(const PoseGraph& graph);
#ifdef DANCE_HAVE_XNNPACK
Result<std::unique_ptr<PoseEngine>> make_xnnpack_engine(const PoseGraph& graph);
#endif

}  // namespace dance
