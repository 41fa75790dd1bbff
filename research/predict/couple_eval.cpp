#include "research/predict/couple_eval.h"

#include <algorithm>
#include <cmath>

#include "core/motion/palm_pull.h"
#include "core/net/mono_clock.h"
#include "research/predict/predict_eval.h"
#include "testing/motion/motion_measures.h"
#include "transformers/partner/partner_guide.h"
#include "transformers/predict/dance_extrapolator.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr double kCoupleWarmUp_s = 4.0;
constexpr std::size_t kJudgedEvery = 4;
constexpr double kCoupleLearnEvery_s = 0.25;
constexpr std::array<Bone, 4> kArmJoints{Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightLowerArm,
                                         Bone::kRightHand};
const GuestId kHere = *GuestId::parse("here");

struct Sums {
  CouplePredictionErrors sum;
  std::vector<float> held_m;
  std::size_t moments = 0, palms = 0;
};

Palms palms_of(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return {palm_of(skeleton, frames, 0), palm_of(skeleton, frames, 1)};
}

double arms_error_m(const Skeleton& skeleton, Pose a, Pose b) {
  a.p_WH_m = b.p_WH_m = Vector3f::Zero();
  a.R_PB[0] = b.R_PB[0] = Eigen::Quaternionf::Identity();
  BodyFrames x, y;
  forward_kinematics(skeleton, a, x);
  forward_kinematics(skeleton, b, y);
  double sum = 0.0;
  for (const Bone bone : kArmJoints)
    sum += static_cast<double>((x.position(bone) - y.position(bone)).norm());
  return sum / static_cast<double>(kArmJoints.size());
}

// The nearest palm of the other dancer to each of ours.
float nearest_m(const Palms& ours, const Palms& theirs, std::size_t side) {
  return std::min((theirs[0] - ours[side]).norm(), (theirs[1] - ours[side]).norm());
}

// One dancer, predicted at one horizon beside one other.
struct Course {
  PartnerTracks dancers;
  PartnerGuide guide;
  std::size_t fed = 0;
  Palms before{};
  bool has_before = false;
};

void keep_palms(const std::optional<std::array<PalmGuesses, 2>>& said, const Palms& alone,
                const Palms& truth, const std::array<bool, 2>& is_held, std::size_t horizon,
                std::vector<PalmMoment>& kept) {
  if (!said) return;
  for (std::size_t side = 0; side < 2; ++side)
    if ((*said)[side].near > 0.0f)
      kept.push_back({(*said)[side], truth[side] - alone[side], horizon, is_held[side]});
}

void judge_dancer(const PredictTake& take, const std::vector<Pose>& heard,
                  const PredictTake& partner, const std::vector<Pose>& partner_heard,
                  const PredictTake& stranger, const std::vector<Pose>& stranger_heard,
                  const CoupleEvalOptions& options, std::vector<std::array<Sums, kBesides>>& sums,
                  std::vector<std::array<double, kForecasts>>& plain,
                  std::vector<std::size_t>& held, CoupleEval& eval, Duration& guiding,
                  std::size_t& guided) {
  const std::size_t horizons = options.horizons.size();
  DanceExtrapolator extrapolator(options.model);
  extrapolator.set_body(take.skeleton);
  std::vector<std::array<std::unique_ptr<Course>, kBesides>> courses(horizons);
  for (auto& by_beside : courses)
    for (std::size_t b = 0; b < kBesides; ++b) {
      by_beside[b] = std::make_unique<Course>();
      by_beside[b]->guide.set_dancers(&by_beside[b]->dancers);
      by_beside[b]->guide.set_body(take.skeleton);
    }
  double next_learning_s = 0.0;
  for (std::size_t i = 0; i < heard.size(); ++i) {
    const double at_s = static_cast<double>(i) / take.hz;
    extrapolator.observe(heard[i], heard[i].capture_time);
    if (at_s >= next_learning_s) {
      next_learning_s += kCoupleLearnEvery_s;
      extrapolator.learner()->learn();
    }
    const bool is_judged = at_s >= kCoupleWarmUp_s && i % kJudgedEvery == 0;
    eval.moments += is_judged;
    for (std::size_t h = 0; h < horizons; ++h) {
      const auto ahead =
          static_cast<std::size_t>(std::lround(options.horizons[h].as_seconds() * take.hz));
      if (i + ahead >= take.poses.size()) continue;
      const MonoTime moment =
          heard[i].capture_time + Duration::seconds(static_cast<double>(ahead) / take.hz);
      const Pose& truth = take.poses[i + ahead];
      const Palms palms = palms_of(take.skeleton, truth);
      const Palms now = palms_of(take.skeleton, take.poses[i]);
      const Palms partner_now = palms_of(partner.skeleton, partner.poses[i]);
      const Palms partner_then = palms_of(partner.skeleton, partner.poses[i + ahead]);
      std::array<bool, 2> is_held;
      for (std::size_t side = 0; side < 2; ++side)
        is_held[side] = nearest_m(now, partner_now, side) < kHold_m &&
                        nearest_m(palms, partner_then, side) < kHold_m;
      Pose alone;
      extrapolator.predict(moment, alone);
      for (std::size_t b = 0; b < kBesides; ++b) {
        Course& course = *courses[h][b];
        const auto& other = b == 1 ? partner_heard : stranger_heard;
        const MonoTime begin = mono_now();
        if (b > 0) {
          const Skeleton& body = (b == 1 ? partner : stranger).skeleton;
          for (; course.fed <= i + ahead && course.fed < other.size(); ++course.fed)
            course.dancers.take(kHere, other[course.fed], &body);
        }
        Pose pose = alone;
        course.guide.observe(heard[i], moment, extrapolator);
        course.guide.set_shown(moment, moment);
        course.guide.guide(moment, pose);
        if (b == 1) {
          guiding += mono_now() - begin;
          ++guided;
        }
        const Palms shown = palms_of(take.skeleton, pose);
        Sums& s = sums[h][b];
        if (course.has_before && i > 0 && is_judged)
          for (std::size_t side = 0; side < 2; ++side)
            s.sum.step_m += static_cast<double>((shown[side] - course.before[side]).norm());
        course.before = shown;
        course.has_before = true;
        if (!is_judged) continue;
        if (b == 1 && options.keeps_palms)
          keep_palms(course.guide.guesses(moment, alone), palms_of(take.skeleton, alone), palms,
                     is_held, h, eval.palms);
        if (b > 0 && h == 0 && course.guide.partner()) eval.coupled[b] += 1.0;
        s.sum.body_m += body_error_m(take.skeleton, pose, truth);
        s.sum.arms_m += arms_error_m(take.skeleton, pose, truth);
        ++s.moments;
        for (std::size_t side = 0; side < 2; ++side) {
          const float error = (shown[side] - palms[side]).norm();
          s.sum.world_m += static_cast<double>(error);
          ++s.palms;
          if (!is_held[side]) continue;
          s.held_m.push_back(error);
          held[h] += b == 0;
        }
      }
      if (!is_judged) continue;
      for (std::size_t f = 1; f < kForecasts; ++f)
        plain[h][f] += body_error_m(take.skeleton,
                                    plain_forecast(static_cast<Forecast>(f), &heard[i], take.hz,
                                                   static_cast<double>(ahead) / take.hz),
                                    truth);
    }
  }
}

}  // namespace

CoupleEval evaluate_couples(const std::vector<CoupleTake>& given,
                            const CoupleEvalOptions& options) {
  CoupleEval eval;
  const std::size_t horizons = options.horizons.size();
  std::vector<CoupleTake> couples = given;
  for (CoupleTake& couple : couples) join_palms(couple, static_cast<float>(options.join_m));
  Random random(1);
  std::vector<std::array<std::vector<Pose>, 2>> heard(couples.size());
  for (std::size_t c = 0; c < couples.size(); ++c)
    for (std::size_t d = 0; d < 2; ++d)
      heard[c][d] = trembling(couples[c][d].poses, options.noise_deg, random);
  std::vector<std::array<Sums, kBesides>> sums(horizons);
  std::vector<std::array<double, kForecasts>> plain(horizons);
  std::vector<std::size_t> held(horizons);
  Duration guiding;
  std::size_t guided = 0;
  for (std::size_t c = 0; c < couples.size(); ++c) {
    // A dancer of the other role from the next dance.
    const std::size_t other = (c + 1) % couples.size();
    for (std::size_t d = 0; d < 2; ++d)
      judge_dancer(couples[c][d], heard[c][d], couples[c][1 - d], heard[c][1 - d],
                   couples[other][1 - d], heard[other][1 - d], options, sums, plain, held, eval,
                   guiding, guided);
  }
  eval.errors.resize(horizons);
  for (std::size_t h = 0; h < horizons; ++h) {
    double best = 1e9;
    for (const std::size_t f : kForecastBaselines) best = std::min(best, plain[h][f]);
    const auto moments = static_cast<double>(std::max<std::size_t>(1, sums[h][0].moments));
    eval.best_dead_reckoning_m.push_back(best / moments);
    eval.held.push_back(static_cast<double>(held[h]) /
                        static_cast<double>(std::max<std::size_t>(1, sums[h][0].palms)));
    for (std::size_t b = 0; b < kBesides; ++b) {
      Sums& s = sums[h][b];
      CouplePredictionErrors& e = eval.errors[h][b];
      e = s.sum;
      e.body_m /= moments;
      e.arms_m /= moments;
      e.world_m /= 2.0 * moments;
      e.step_m /= 2.0 * moments;
      if (s.held_m.empty()) continue;
      for (const float m : s.held_m) e.hold_m += static_cast<double>(m);
      e.hold_m /= static_cast<double>(s.held_m.size());
      std::sort(s.held_m.begin(), s.held_m.end());
      e.hold_p95_m = static_cast<double>(s.held_m[s.held_m.size() * 19 / 20]);
    }
  }
  for (double& coupled : eval.coupled)
    coupled /= static_cast<double>(std::max<std::size_t>(1, eval.moments));
  eval.ns_per_frame = static_cast<double>(guiding.count_ns()) /
                      static_cast<double>(std::max<std::size_t>(1, guided));
  return eval;
}

}  // namespace dance
