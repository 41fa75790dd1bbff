// Proportions: a dancer's bone lengths, estimated in the first seconds and then held. Each is the
// median over pictures, of left and right together, of the length in the network's world points
// (which varies by six percent from picture to picture) and of that in the picture, for bones that
// lie across the view, at the body's depth.
//
// Units/frames: metres of the network go in, true metres come out.
// Ownership:    keeps its samples (about 10 KB); never allocates.
// Threads:      none inside; one owner.
// Failure:      lengths that were not seen, or that no adult or child has, are average for the rest
//               of the body.
#pragma once

#include <array>
#include <optional>

#include "producers/camera/depth_hint.h"
#include "producers/camera/solver/body_shape.h"
#include "producers/camera/solver/observation.h"

namespace dance {

class Proportions {
 public:
  // Pictures after which the first estimate is used, and after which it is held.
  static constexpr int kFirst = 20, kHeld = 150;

  // `height_m`: given by the dancer; else the stereo scale decides, else the network's metres are
  // taken as true.
  explicit Proportions(std::optional<double> height_m = {}) : height_m_(height_m) {}
  void reset();
  // Lengths that were measured otherwise: they are held, whatever pictures say.
  void hold(const BodyLengths& lengths);

  // `pictured_m`: the landmarks where their rays meet the body's depth, in C and in metres of the
  // body that was fitted.
  void see(const Observation& seen, const std::array<Eigen::Vector3d, kLandmarkCount>& pictured_m,
           const std::optional<DepthHint>& depth);
  // The fitted body has changed: lengths measured in pictures with the old one are dropped.
  void discard_image_lengths();
  // hold() gave them.
  bool is_measured() const { return held_.has_value(); }
  int pictures() const { return pictures_; }
  bool is_held() const { return pictures_ >= kHeld; }
  BodyLengths lengths() const;

 private:
  struct Samples {
    std::array<float, kHeld> values{};
    int count = 0;
  };
  using Points = std::array<Eigen::Vector3d, kLandmarkCount>;
  using AllSamples = std::array<Samples, kLengthCount>;
  static void measure(const Observation& seen, const Points& points, bool across_only,
                      AllSamples& samples);
  // False where nothing was measured well enough.
  static bool medians(const AllSamples& samples, BodyLengths& lengths,
                      std::array<bool, kLengthCount>& is_measured);
  double scale(const BodyLengths& measured) const;

  std::optional<double> height_m_;
  AllSamples network_, pictured_;
  double scale_sum_ = 0.0, scale_weight_ = 0.0;
  int pictures_ = 0;
  std::optional<BodyLengths> held_;
};

}  // namespace dance
