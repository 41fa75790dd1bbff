// JointLengths: the lengths of a dancer's body in baselines, from joints on which the rays of two
// cameras meet: medians over moments, freed from what noise adds to a length. With the dancer's
// height they give the baseline in metres.
//
// Units/frames: baselines (relative_pose.h); heights in metres.
// Ownership:    keeps its samples (about 20 KB); never allocates.
// Threads:      none inside; one owner.
// Failure:      lengths() has none where legs or back were not measured well enough; other lengths
//               that were not measured are average for the rest of the body.
#pragma once

#include <array>
#include <optional>

#include "producers/camera/multiview/key_moments.h"
#include "producers/camera/multiview/relative_pose.h"
#include "producers/camera/multiview/view_history.h"
#include "producers/camera/solver/body_shape.h"

namespace dance {

class JointLengths {
 public:
  // Measures all moments anew, with this pose.
  void begin(const RelativePose& pose, const KeyMoments& moments);
  // Some of the moments; true once all were measured.
  bool step(const KeyMoments& moments, const ViewHistory& other, int most_moments);

  std::optional<BodyLengths> lengths() const;
  // The standing height that belongs to these lengths and to how far the ears are above the
  // shoulders: all that joints show of it.
  double stature(const BodyLengths& lengths) const;
  // Moments that both saw, and the share of rays in them that meet before both cameras.
  int moments() const { return moments_; }
  double met_share() const { return looked_ > 0 ? static_cast<double>(met_) / looked_ : 0.0; }
  // The middle angle at which the rays of both cameras meet.
  double angle_rad() const { return moments_ > 0 ? angle_sum_ / moments_ : 0.0; }

 private:
  static constexpr std::size_t kMost = 2 * KeyMoments::kCapacity;
  struct Samples {
    std::array<float, kMost> values;
    std::size_t count = 0;
  };
  void measure(const ViewPoints& first, const ViewMoment& other);
  // 0 where too little was measured.
  static double median_of(const Samples& samples);

  RelativePose pose_;
  std::uint64_t next_ = 0;
  std::array<Samples, kLengthCount> samples_;
  Samples neck_;  // from the middle of the shoulders to that of the ears
  int moments_ = 0;
  int looked_ = 0;
  int met_ = 0;
  double angle_sum_ = 0.0;
};

}  // namespace dance
