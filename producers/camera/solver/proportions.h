// Proportions: how long a dancer's bones are, learned from the first seconds and then held. Each length is the median over pictures of what the
// network says of left and right alike; what it says of a single picture differs by six percent.
//
// Units/frames: metres of the network go in, true metres come out.
// Ownership:    keeps its samples (about 10 KB); never allocates.
// Threads:      none inside; one owner.
// Failure:      lengths that were not seen, or that no adult or child has, are average for the rest of the body.
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

  // `height_m`: what the dancer says; else a second eye's scale decides, else the network's metres are true.
  explicit Proportions(std::optional<double> height_m = {}) : height_m_(height_m) {}
  void reset();

  void see(const Observation& seen, const std::optional<DepthHint>& depth);
  int pictures() const { return pictures_; }
  bool is_held() const { return pictures_ >= kHeld; }
  BodyLengths lengths() const;

 private:
  struct Samples {
    std::array<float, kHeld> values{};
    int count = 0;
  };
  double scale(const BodyLengths& measured) const;

  std::optional<double> height_m_;
  std::array<Samples, kLengthCount> samples_;
  double scale_sum_ = 0.0, scale_weight_ = 0.0;
  int pictures_ = 0;
};

}  // namespace dance
