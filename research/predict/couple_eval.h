// Partner-aware prediction judged on recorded couples: each dancer predicted alone, beside the
// partner of the dance, and beside a dancer of another dance, who must bring nothing.
//
// Units/frames: horizons as Durations: what is known of the partner reaches to the moment that is
//               predicted; errors in metres. A hold: two palms of the recording no further apart
//               than kHold_m, at the newest pose and at the moment predicted.
// Ownership:    plain values.
// Threads:      none inside; learners run every quarter of a second of the dance.
// Failure:      none; takes that are too short have no part in it.
#pragma once

#include <string>
#include <vector>

#include "research/predict/couple_takes.h"
#include "research/predict/palm_fit.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

enum class Beside : std::uint8_t { kAlone, kPartner, kStranger };
constexpr std::size_t kBesides = 3;
constexpr std::array<const char*, kBesides> kBesideNames{"alone", "partner", "stranger"};
constexpr float kHold_m = 0.25f;

struct CoupleEvalOptions {
  std::vector<Duration> horizons;
  double noise_deg = 0.0;
  double join_m = 0.0;
  std::shared_ptr<const PredictModel> model;
  bool keeps_palms = false;  // what the partner's palms said at each judged moment
};

struct CouplePredictionErrors {
  double body_m = 0.0;   // joints, the hips' place and rotation removed
  double arms_m = 0.0;   // of these, elbows and hands
  double world_m = 0.0;  // palms in W
  double hold_m = 0.0;   // palms in a hold, from where they met the partner's
  double hold_p95_m = 0.0;
  double step_m = 0.0;  // of palms in W against the dance, from picture to picture
};

struct CoupleEval {
  std::size_t moments = 0;
  // By horizon.
  std::vector<std::array<CouplePredictionErrors, kBesides>> errors;
  std::vector<double> best_dead_reckoning_m;  // the same as body_m of the best plain forecast
  std::vector<double> held;                   // of the palms, the part that is in a hold
  std::array<double, kBesides> coupled{};     // of the time a partner was found
  double ns_per_frame = 0.0;                  // that the partner costs beside the prediction
  std::vector<PalmMoment> palms;
};

CoupleEval evaluate_couples(const std::vector<CoupleTake>& couples,
                            const CoupleEvalOptions& options);
std::string couple_eval_table(const CoupleEval& eval, const CoupleEvalOptions& options);
std::string couple_eval_json(const CoupleEval& eval, const CoupleEvalOptions& options);

}  // namespace dance
