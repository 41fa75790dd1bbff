// Proportions: how long a dancer's bones are, learned from the first seconds and then held. Each
// length is the median over pictures, of left and right alike, of what the network says in space
// (which differs by six percent from picture to picture) and of what the picture itself shows of
// bones that lie across the view, at the depth where the body was found.
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
  // Pictures after which a first guess is worth showing, and after which it is held.
  static constexpr int kFirst = 20, kHeld = 150;

  // `height_m`: what the dancer says; else a second eye's scale decides, else the network's metres
  // are true.
  explicit Proportions(std::optional<double> height_m = {}) : height_m_(height_m) {}
  void reset();

  // `pictured_m`: the landmarks where their rays meet the body's depth, in C and in metres of the
  // body that was fitted.
  void see(const Observation& seen, const std::array<Eigen::Vector3d, kLandmarkCount>& pictured_m,
           const std::optional<DepthHint>& depth);
  // The body that is fitted has changed: what was pictured on it counts no more.
  void forget_pictured();
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
  AllSamples told_, pictured_;
  double scale_sum_ = 0.0, scale_weight_ = 0.0;
  int pictures_ = 0;
};

}  // namespace dance
