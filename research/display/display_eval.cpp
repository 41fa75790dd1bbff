#include "research/display/display_eval.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/motion/short_extrapolator.h"
#include "core/pose/kinematics.h"
#include "core/program/figures.h"
#include "formats/bvh/clip_file.h"

namespace dance {
namespace {

constexpr std::uint64_t kSeed = 22;
constexpr std::size_t kWarmUp = 8;

// Mean over joints and ends.
double error_mm(const BodyFrames& a, const BodyFrames& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    sum += static_cast<double>((a.p_WB_m[i] - b.p_WB_m[i]).norm());
  for (std::size_t i = 0; i < kTipCount; ++i)
    sum += static_cast<double>((a.p_WT_m[i] - b.p_WT_m[i]).norm());
  return 1e3 * sum / static_cast<double>(kBoneCount + kTipCount);
}

double lowest_mm(const BodyFrames& frames) {
  return 1e3 * static_cast<double>(std::min(
                   {frames.position(Bone::kLeftFoot).y(), frames.position(Bone::kRightFoot).y(),
                    frames.position(Bone::kLeftToes).y(), frames.position(Bone::kRightToes).y(),
                    frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y()}));
}

double turn_deg(const BodyFrames& a, const BodyFrames& b, Bone bone) {
  constexpr double kDegrees = 57.29577951308232;
  return kDegrees *
         static_cast<double>(a.R_WB[index_of(bone)].angularDistance(b.R_WB[index_of(bone)]));
}

double off_mm(const BodyFrames& a, const BodyFrames& b, Bone bone) {
  return 1e3 * static_cast<double>((a.position(bone) - b.position(bone)).norm());
}

// Sums, until the number of moments is known.
void add_part(const BodyFrames& held, const BodyFrames& ours, const BodyFrames& danced, Bone bone,
              double share, PartErrors& errors) {
  errors.held_mean_mm += share * off_mm(held, danced, bone);
  errors.ours_mean_mm += share * off_mm(ours, danced, bone);
  errors.held_mean_deg += share * turn_deg(held, danced, bone);
  errors.ours_mean_deg += share * turn_deg(ours, danced, bone);
}

void divide(PartErrors& errors, double moments) {
  for (double* sum :
       {&errors.held_mean_mm, &errors.ours_mean_mm, &errors.held_mean_deg, &errors.ours_mean_deg})
    *sum /= moments;
}

struct Samples {
  PartErrors head, hands;
  std::vector<double> held_mm, ours_mm;
  double below_floor_mm = 0.0;
};

void summarize(std::vector<double>& values, double& mean, double& p95) {
  std::sort(values.begin(), values.end());
  for (const double value : values) mean += value / static_cast<double>(values.size());
  p95 = percentile<double>(values, 0.95);
}

}  // namespace

Result<DisplayTake> load_display_take(const std::string& path, double hz) {
  DANCE_TRY(PredictTake heard, load_predict_take(path, hz));
  DANCE_TRY(LoadedClip loaded, load_clip(path));
  return DisplayTake{std::move(heard), std::move(loaded.clip)};
}

DisplayEval evaluate_display(const std::vector<DisplayTake>& takes,
                             const DisplayEvalOptions& options) {
  DisplayEval eval;
  std::vector<Samples> samples(options.horizons_ms.size());
  Random random(kSeed);
  std::chrono::nanoseconds spent{0};
  std::size_t told = 0;
  for (const DisplayTake& take : takes) {
    const std::vector<Pose> heard = trembling(take.heard.poses, options.noise_deg, random);
    const Skeleton& skeleton = take.heard.skeleton;
    ShortExtrapolator motion;
    for (std::size_t i = 0; i < heard.size(); ++i) {
      motion.observe(heard[i], heard[i].capture_time);
      const double now_s = static_cast<double>(i) / take.heard.hz;
      if (i < kWarmUp || now_s + 0.1 > take.danced.length().as_seconds()) continue;
      ++eval.moments;
      BodyFrames held, ours, danced;
      forward_kinematics(skeleton, heard[i], held);
      for (std::size_t h = 0; h < samples.size(); ++h) {
        const Duration ahead = Duration::seconds(1e-3 * options.horizons_ms[h]);
        Pose truth;
        sample_clip(take.danced, Duration::seconds(now_s + 1e-7) + ahead, ClipEnd::kHold, truth);
        forward_kinematics(skeleton, truth, danced);
        const auto before = std::chrono::steady_clock::now();
        const Pose shown = motion.at(heard[i].capture_time + ahead, skeleton);
        spent += std::chrono::steady_clock::now() - before;
        ++told;
        forward_kinematics(skeleton, shown, ours);
        samples[h].held_mm.push_back(error_mm(held, danced));
        samples[h].ours_mm.push_back(error_mm(ours, danced));
        add_part(held, ours, danced, Bone::kHead, 1.0, samples[h].head);
        for (const Bone hand : {Bone::kLeftHand, Bone::kRightHand})
          add_part(held, ours, danced, hand, 0.5, samples[h].hands);
        const double floor_mm = std::min(0.0, lowest_mm(held));
        samples[h].below_floor_mm = std::max(samples[h].below_floor_mm, floor_mm - lowest_mm(ours));
      }
    }
  }
  for (Samples& it : samples) {
    DisplayErrors& errors = eval.errors.emplace_back();
    summarize(it.held_mm, errors.held_mean_mm, errors.held_p95_mm);
    summarize(it.ours_mm, errors.ours_mean_mm, errors.ours_p95_mm);
    errors.below_floor_mm = it.below_floor_mm;
    errors.head = it.head;
    errors.hands = it.hands;
    const double moments = std::max<double>(1.0, static_cast<double>(eval.moments));
    divide(errors.head, moments);
    divide(errors.hands, moments);
  }
  if (told > 0) eval.ns_per_pose = static_cast<double>(spent.count()) / static_cast<double>(told);
  return eval;
}

}  // namespace dance
