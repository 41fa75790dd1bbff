// Prediction judged on recorded dances: what it says of moments to come beside what anyone could
// say.
//
// Units/frames: horizons as Durations; errors in metres: mean distance of the joints, the hips'
//               place and rotation removed (testing/motion/motion_measures.h), of poses heard with
//               the sensor's trembling to the dance without.
// Ownership:    plain values.
// Threads:      none inside; what learns in the background learns in between, every quarter of a
//               second of the dance.
// Failure:      none; takes that are too short for a horizon have no part in it.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "research/predict/predict_takes.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

// The pose after `ahead` as others say it, from the newest poses, oldest first, 1/hz apart.
enum class Forecast : std::uint8_t {
  kOurs,
  kZeroVelocity,
  kConstantVelocity,
  kDampedVelocity,         // of the last six frames, dying within 100 ms
  kReferenceExtrapolator,  // as the published DanceGraph extrapolates
};
constexpr std::size_t kForecasts = 5;
constexpr std::array<const char*, kForecasts> kForecastNames{
    "ours", "zero_velocity", "constant_velocity", "damped_velocity", "reference_extrapolator"};
// Those that ours must not be worse than.
constexpr std::array<std::size_t, 3> kForecastBaselines{1, 2, 3};
Pose plain_forecast(Forecast forecast, const Pose* newest, double hz, double ahead_s);

struct PredictEvalOptions {
  std::vector<Duration> horizons;
  double noise_deg = 0.0;
  // Every file is the first of a dancer that nothing is known of, and of whom no model was trained.
  bool fresh = false;
  std::shared_ptr<const PredictModel> model;
};

using ForecastErrors = std::array<double, kForecasts>;

struct PredictEval {
  std::size_t frames = 0;
  std::size_t moments = 0;             // that were judged
  std::vector<ForecastErrors> mean_m;  // by horizon
  // Of the moments by how long their dancer had been seen: 0 to 30 s, 30 s to 3 min, longer.
  struct Acquainted {
    std::size_t moments = 0;
    std::vector<ForecastErrors> mean_m;
  };
  std::array<Acquainted, 3> acquainted;
  // The 10 s in which ours did worst against the best baseline of those 10 s.
  struct Worst {
    double ratio = 0.0;
    std::string take;
    double from_s = 0.0;
  };
  std::vector<Worst> worst;  // by horizon
  double ns_per_frame = 0.0;
  double ns_per_learning = 0.0;  // of a frame, beside the pose path
  std::size_t dancers = 0, known_dancers = 0;
};

PredictEval evaluate_prediction(const std::vector<PredictTake>& takes,
                                const PredictEvalOptions& options);
std::string predict_eval_table(const PredictEval& eval, const PredictEvalOptions& options);
std::string predict_eval_json(const PredictEval& eval, const PredictEvalOptions& options);

}  // namespace dance
