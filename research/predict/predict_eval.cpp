#include "research/predict/predict_eval.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/net/mono_clock.h"
#include "testing/motion/motion_measures.h"
#include "transformers/predict/dance_predictor.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr double kWarmUp_s = 4.0;
constexpr std::size_t kEvery = 8;
constexpr double kLearnEvery_s = 0.25;
constexpr double kWindow_s = 10.0;
constexpr std::array<double, 2> kAcquainted_s{30.0, 180.0};
constexpr double kDamping_s = 0.1;
constexpr std::size_t kSlopeFrames = 6;
// Between two takes, so that nobody takes the second for the first's next frame.
constexpr Duration kBetweenTakes = Duration::s(5);

struct Dancer {
  BoneLengths lengths;
  std::unique_ptr<DancePredictor> predictor;
  double seen_s = 0.0;
  MonoTime time;
};

struct Judged {
  double at_s;
  std::vector<ForecastErrors> errors;  // by horizon; negative: none
};

bool is_same(const BoneLengths& a, const BoneLengths& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > 0.004f) return false;
  return true;
}

std::unique_ptr<DancePredictor> meet(const Skeleton& skeleton, const PredictEvalOptions& options) {
  auto predictor = std::make_unique<DancePredictor>(options.model);
  const bool known = options.model->knows(skeleton);
  predictor->set_acquaintance(!known          ? Acquaintance::kOthers
                              : options.fresh ? Acquaintance::kNone
                                              : Acquaintance::kDancer);
  return predictor;
}

void note_worst(const std::vector<Judged>& judged, const std::string& name, PredictEval& eval) {
  for (std::size_t h = 0; h < eval.worst.size(); ++h)
    for (std::size_t first = 0; first < judged.size(); ++first) {
      ForecastErrors sum{};
      std::size_t last = first;
      for (; last < judged.size() && judged[last].at_s < judged[first].at_s + kWindow_s; ++last) {
        if (judged[last].errors[h][0] < 0.0) continue;
        for (std::size_t f = 0; f < kForecasts; ++f) sum[f] += judged[last].errors[h][f];
      }
      // Takes that are shorter are one window.
      if (last == judged.size() && first > 0) break;
      double best = 1e9;
      for (const std::size_t f : kForecastBaselines) best = std::min(best, sum[f]);
      if (best <= 0.0 || sum[0] / best <= eval.worst[h].ratio) continue;
      eval.worst[h] = {sum[0] / best, name, judged[first].at_s};
    }
}

}  // namespace

Pose plain_forecast(Forecast forecast, const Pose* newest, double hz, double ahead_s) {
  Pose out = *newest;
  const Pose& before = *(newest - 1);
  // Slopes per frame, and how many frames they go on.
  double frames = ahead_s * hz;
  switch (forecast) {
    case Forecast::kOurs:
    case Forecast::kZeroVelocity:
      return out;
    case Forecast::kConstantVelocity:
    case Forecast::kDampedVelocity:
      break;
    case Forecast::kReferenceExtrapolator:
      // It goes on from the pose before the newest by (step + ahead) / ahead of the step: the
      // newest and step / ahead more.
      frames = 1.0 / (ahead_s * hz);
      break;
  }
  if (forecast == Forecast::kDampedVelocity)
    frames = kDamping_s * hz * (1.0 - std::exp(-ahead_s / kDamping_s));
  const auto go_on = [&](auto slope_of_bone, const Vector3f& place_slope) {
    for (std::size_t b = 0; b < kBoneCount; ++b)
      out.R_PB[b] = (newest->R_PB[b] * exp_rotation(slope_of_bone(b) * static_cast<float>(frames)))
                        .normalized();
    out.p_WH_m = newest->p_WH_m + place_slope * static_cast<float>(frames);
  };
  if (forecast != Forecast::kDampedVelocity) {
    go_on(
        [&](std::size_t b) {
          return rotation_vector(before.R_PB[b].conjugate() * newest->R_PB[b]);
        },
        Vector3f(newest->p_WH_m - before.p_WH_m));
    return out;
  }
  // Least squares over six frames, as turns from the newest.
  float size = 0.0f;
  Vector3f place = Vector3f::Zero();
  std::array<Vector3f, kBoneCount> turn;
  turn.fill(Vector3f::Zero());
  for (std::size_t k = 0; k < kSlopeFrames; ++k) {
    const float arm = 0.5f * static_cast<float>(kSlopeFrames - 1) - static_cast<float>(k);
    const Pose& then = *(newest - k);
    size += arm * arm;
    place += arm * (then.p_WH_m - newest->p_WH_m);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      turn[b] += arm * rotation_vector(newest->R_PB[b].conjugate() * then.R_PB[b]);
  }
  go_on([&](std::size_t b) { return Vector3f(turn[b] / size); }, Vector3f(place / size));
  return out;
}

PredictEval evaluate_prediction(const std::vector<PredictTake>& takes,
                                const PredictEvalOptions& options) {
  PredictEval eval;
  const std::size_t horizons = options.horizons.size();
  eval.mean_m.resize(horizons);
  eval.worst.resize(horizons);
  for (auto& acquainted : eval.acquainted) acquainted.mean_m.resize(horizons);
  std::vector<std::size_t> counts(horizons);
  std::array<std::vector<std::size_t>, 3> acquainted_counts;
  acquainted_counts.fill(std::vector<std::size_t>(horizons));
  std::vector<Dancer> dancers;
  Duration observing, learning;
  Random random(1);
  for (const PredictTake& take : takes) {
    const BoneLengths lengths = bone_lengths(take.skeleton);
    auto dancer = std::find_if(dancers.begin(), dancers.end(),
                               [&](const Dancer& d) { return is_same(d.lengths, lengths); });
    if (dancer == dancers.end()) {
      eval.known_dancers += options.model->knows(take.skeleton);
      dancers.push_back({lengths, meet(take.skeleton, options), 0.0, MonoTime()});
      dancer = dancers.end() - 1;
    } else if (options.fresh) {
      *dancer = {lengths, meet(take.skeleton, options), 0.0, MonoTime()};
    }
    std::vector<Pose> heard = trembling(take.poses, options.noise_deg, random);
    const Duration shift =
        dancer->time.is_set() ? dancer->time + kBetweenTakes - MonoTime() : Duration();
    std::vector<Judged> judged;
    double next_learning_s = 0.0;
    for (std::size_t i = 0; i < heard.size(); ++i) {
      const double at_s = static_cast<double>(i) / take.hz;
      heard[i].capture_time += shift;
      const MonoTime begin = mono_now();
      dancer->predictor->observe(heard[i]);
      observing += mono_now() - begin;
      if (at_s >= next_learning_s) {
        next_learning_s += kLearnEvery_s;
        const MonoTime learning_begin = mono_now();
        dancer->predictor->personal()->learn();
        learning += mono_now() - learning_begin;
      }
      if (at_s < kWarmUp_s || i % kEvery != 0) continue;
      const double seen_s = dancer->seen_s + at_s;
      const std::size_t stage = seen_s < kAcquainted_s[0] ? 0 : seen_s < kAcquainted_s[1] ? 1 : 2;
      Judged moment{at_s, std::vector<ForecastErrors>(horizons)};
      ++eval.moments;
      ++eval.acquainted[stage].moments;
      for (std::size_t h = 0; h < horizons; ++h) {
        const double ahead_s = options.horizons[h].as_seconds();
        const auto ahead = static_cast<std::size_t>(std::lround(ahead_s * take.hz));
        moment.errors[h].fill(-1.0);
        if (i + ahead >= take.poses.size()) continue;
        const double whole_s = static_cast<double>(ahead) / take.hz;
        ++counts[h];
        ++acquainted_counts[stage][h];
        for (std::size_t f = 0; f < kForecasts; ++f) {
          Pose pose;
          if (f == 0) {
            const MonoTime from = mono_now();
            dancer->predictor->predict(heard[i].capture_time + Duration::seconds(whole_s), pose);
            if (h == 0) observing += (mono_now() - from) * static_cast<std::int64_t>(kEvery);
          } else {
            pose = plain_forecast(static_cast<Forecast>(f), &heard[i], take.hz, whole_s);
          }
          const double error = body_error_m(take.skeleton, pose, take.poses[i + ahead]);
          moment.errors[h][f] = error;
          eval.mean_m[h][f] += error;
          eval.acquainted[stage].mean_m[h][f] += error;
        }
      }
      judged.push_back(std::move(moment));
    }
    note_worst(judged, take.name, eval);
    eval.frames += heard.size();
    dancer->seen_s += static_cast<double>(heard.size()) / take.hz;
    dancer->time = heard.back().capture_time;
  }
  const auto divide = [](ForecastErrors& sums, std::size_t count) {
    for (double& sum : sums) sum = count > 0 ? sum / static_cast<double>(count) : 0.0;
  };
  for (std::size_t h = 0; h < horizons; ++h) {
    divide(eval.mean_m[h], counts[h]);
    for (std::size_t s = 0; s < 3; ++s)
      divide(eval.acquainted[s].mean_m[h], acquainted_counts[s][h]);
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(eval.frames, 1));
  eval.ns_per_frame = static_cast<double>(observing.count_ns()) / frames;
  eval.ns_per_learning = static_cast<double>(learning.count_ns()) / frames;
  eval.dancers = dancers.size();
  return eval;
}

}  // namespace dance
