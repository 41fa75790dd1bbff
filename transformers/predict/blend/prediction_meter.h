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
#include "transformers/prediction_lead.h"

namespace dance {

class PredictionMeter {
 public:
  static constexpr auto& kHorizons = PredictionLead::kHorizons;

  PredictionMeter() : skeleton_(average_skeleton()) {}
  void set_body(const Skeleton& skeleton) { skeleton_ = skeleton; }
  void clear();

  // Which distance is to be predicted next; nothing waits to be asked more often than that.
  Duration next_horizon() const { return kHorizons[next_]; }
  // It was predicted from `newest`, with measured_lead().
  void note(const Pose& newest, const Pose& prediction, MonoTime moment);
  static PredictionLead measured_lead();
  // Compares what has become known, and whether there was anything. `beat`: of the music that is
  // danced to; 0 where there is none.
  bool learn(const PoseHistory& history, Duration beat);

  bool is_known() const;
  // Mean error of a prediction so far ahead.
  double error_m(Duration horizon) const;
  // The farthest distance whose predictions are not worse than that; nothing is known beyond the
  // last horizon.
  Duration reach(double most_error_m) const;
  // By how much ways of that horizon are to be lengthened, so that the wave of the four-count in
  // them is neither late nor early.
  float gain(std::size_t horizon) const;

 private:
  using Places = std::array<Eigen::Vector3f, kBoneCount>;  // p_HB_m, the hips not turned
  struct Prediction {
    MonoTime moment;
    std::size_t horizon = 0;
    Places from, to;  // the newest pose then, and the prediction
    bool waits = false;
  };
  struct Score {
    double weight = 0.0, error_m = 0.0;  // decayed sums
    // Along the wave of the four-count: the way that was danced, the one predicted, and the wave.
    double danced = 0.0, predicted = 0.0, wave2 = 0.0, waves = 0.0;
  };

  void learn_wave(const PoseHistory& history, const Prediction& prediction, const Places& is,
                  Duration beat);
  void body_positions(const Pose& pose, Places& p_HB_m) const;

  Skeleton skeleton_;
  std::array<Prediction, 64> predictions_{};
  std::size_t write_ = 0, next_ = 0;
  std::array<Score, kHorizons.size()> scores_{};
};

}  // namespace dance
