// PredictionMeter: how good the predictions of one dancer are: asks for predictions at several
// distances, waits for the truth, and compares. From it come how far ahead is worth showing, and
// how much a prediction lags behind.
//
// Units/frames: distances (horizons) are from the newest pose to the moment that is predicted;
//               errors in metres, the mean over joints, with the hips' place and rotation removed.
// Ownership:    plain values; no heap after construction.
// Threads:      none inside; one owner.
// Failure:      before enough predictions have met their truth is_known() is false.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/time.h"
#include "core/pose/history.h"
#include "core/pose/kinematics.h"

namespace dance {

class PredictionMeter {
 public:
  static constexpr std::array<Duration, 6> kHorizons{Duration::ms(60),  Duration::ms(120),
                                                     Duration::ms(180), Duration::ms(240),
                                                     Duration::ms(320), Duration::ms(400)};

  PredictionMeter() : skeleton_(average_skeleton()) {}
  void set_body(const Skeleton& skeleton) { skeleton_ = skeleton; }
  void clear();

  // Which distance is to be predicted next; nothing waits to be asked more often than that.
  Duration next_horizon() const { return kHorizons[next_]; }
  void note(const Pose& pose, MonoTime moment);
  // Compares what has become known.
  void learn(const PoseHistory& history);

  bool is_known() const;
  // Mean error of a prediction so far ahead.
  double error_m(Duration horizon) const;
  // The farthest distance whose predictions are not worse than that; nothing is known beyond the
  // last horizon.
  Duration reach(double most_error_m) const;
  // How far to predict so that what is seen is `ahead` ahead: predictions lag, as they shrink
  // towards the mean.
  Duration lead(Duration ahead) const;

 private:
  struct Prediction {
    MonoTime moment;
    std::size_t horizon = 0;
    std::array<Eigen::Vector3f, kBoneCount> p_HB_m;
    bool waits = false;
  };
  struct Score {
    double weight = 0.0, error_m = 0.0;  // decayed sums
    double against = 0.0, speed2 = 0.0;  // error along the motion, and the motion's own square
  };

  void body_positions(const Pose& pose, std::array<Eigen::Vector3f, kBoneCount>& p_HB_m) const;
  double lag_s(std::size_t horizon) const;

  Skeleton skeleton_;
  std::array<Prediction, 16> predictions_{};
  std::size_t write_ = 0, next_ = 0;
  std::array<Score, kHorizons.size()> scores_{};
};

}  // namespace dance
