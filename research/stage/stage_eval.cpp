#include "research/stage/stage_eval.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "formats/body/hand_layout.h"
#include "research/stage/shown_figure.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kMeets_m = 0.03f;
constexpr float kHolds_m = 0.08f;
constexpr float kStands_m = 0.03f;
constexpr float kStands_m_s = 0.15f;
constexpr double kDeg = 57.29577951308232;
constexpr std::array<Bone, 2> kToes{Bone::kLeftToes, Bone::kRightToes};
constexpr std::array<Tip, 2> kToeTips{Tip::kLeftToes, Tip::kRightToes};

std::optional<double> percentile(std::vector<double>& values, double share) {
  if (values.empty()) return std::nullopt;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// A dancer's own foot, as the skeleton has it: points below ankle, toes' joint and tip.
struct DancedFoot {
  float lowest_m = 0.0f;
  Vector3f ball_W_m;
};

DancedFoot danced_foot(const Skeleton& skeleton, const BodyFrames& at, std::size_t side) {
  const std::size_t foot = index_of(kLegLimbs[side].end), toes = index_of(kToes[side]);
  float ankle_m = 0.0f;
  for (std::size_t b = foot;; b = static_cast<std::size_t>(kBones[b].parent)) {
    ankle_m += skeleton.offset_m[b].y();
    if (b == 0) break;
  }
  const Vector3f down_foot = at.R_WB[foot] * Vector3f::UnitY(),
                 down_toes = at.R_WB[toes] * Vector3f::UnitY();
  const float ball_m = ankle_m + skeleton.offset_m[toes].y();
  const float tip_m = ball_m + skeleton.tip(kToeTips[side]).y();
  DancedFoot danced;
  danced.ball_W_m = at.p_WB_m[toes] - ball_m * down_foot;
  danced.lowest_m = std::min({(at.p_WB_m[foot] - ankle_m * down_foot).y(), danced.ball_W_m.y(),
                              (at.tip(kToeTips[side]) - tip_m * down_toes).y()});
  return danced;
}

// What is kept of one frame for the next ones.
struct Moment {
  std::vector<BodyFrames> danced, shown;
  std::vector<std::array<DancedFoot, 2>> feet;
};

class StageMeter {
 public:
  StageMeter(const StageTake& take, const StageWear& wear) : take_(take) {
    for (const auto& avatar : wear.avatars) shown_.emplace_back(*avatar);
    for (const StageDancer& dancer : take.dancers) {
      const HandLayout layout = hand_layout(dancer.clip.skeleton);
      palms_m_.push_back(
          {0.8f * layout.offset_m[6], 0.8f * layout.offset_m[kFingerBoneCount / 2 + 6]});
    }
  }

  void add(std::span<const PosedFigure> figures, const Moment& before, const Moment& now,
           bool is_first) {
    add_hands(figures, now);
    for (std::size_t d = 0; d < figures.size(); ++d) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (!is_first) add_foot(figures[d], d, side, before, now);
        out_.wrist_twist_deg_max =
            std::max(out_.wrist_twist_deg_max, kDeg * shown_[d].wrist_twist_rad(figures[d], side));
        out_.elbow_twist_deg_max =
            std::max(out_.elbow_twist_deg_max, kDeg * shown_[d].elbow_twist_rad(figures[d], side));
        const double stretch = 100.0 * (figures[d].arm_stretch[side] - 1.0);
        out_.stretch_percent_max = std::max(out_.stretch_percent_max, stretch);
        stretched_ += stretch > 0.1;
        ++arms_;
      }
      if (!is_first) add_steps(d, before, now);
    }
    ++frame_;
  }

  StageMeasures take_measures() {
    out_.hand_gap_mm_p95 = percentile(gaps_, 0.95);
    out_.hand_gap_danced_mm_p95 = percentile(danced_gaps_, 0.95);
    out_.hold_off_mm_p95 = percentile(hold_offs_, 0.95);
    out_.own_hands_off_mm_p95 = percentile(own_offs_, 0.95);
    out_.foot_floor_mm_p95 = percentile(floors_, 0.95);
    out_.foot_floor_danced_mm_p95 = percentile(danced_floors_, 0.95);
    out_.foot_slide_mm_s = mean(slides_);
    out_.foot_slide_danced_mm_s = mean(danced_slides_);
    out_.joint_step_mm_p999 = percentile(steps_, 0.999).value_or(0.0);
    out_.stretched_share_percent =
        arms_ > 0 ? 100.0 * static_cast<double>(stretched_) / static_cast<double>(arms_) : 0.0;
    return out_;
  }

 private:
  Vector3f danced_palm(const Moment& now, std::size_t d, std::size_t side) const {
    const std::size_t hand = index_of(kArmLimbs[side].end);
    return now.danced[d].p_WB_m[hand] + now.danced[d].R_WB[hand] * palms_m_[d][side];
  }

  void add_hands(std::span<const PosedFigure> figures, const Moment& now) {
    const std::size_t hands = 2 * figures.size();
    for (std::size_t a = 0; a < hands; ++a)
      for (std::size_t b = a + 1; b < hands; ++b) {
        const Vector3f danced = danced_palm(now, b / 2, b % 2) - danced_palm(now, a / 2, a % 2);
        if (danced.norm() > kHolds_m) continue;
        const Vector3f shown = shown_[b / 2].palm_W_m(figures[b / 2], b % 2) -
                               shown_[a / 2].palm_W_m(figures[a / 2], a % 2);
        const double off_mm = 1e3 * static_cast<double>((shown - danced).norm());
        if (a / 2 == b / 2) {
          own_offs_.push_back(off_mm);
          continue;
        }
        hold_offs_.push_back(off_mm);
        ++out_.hold_moments;
        if (danced.norm() > kMeets_m) continue;
        ++out_.hand_meetings;
        gaps_.push_back(1e3 * static_cast<double>(shown.norm()));
        danced_gaps_.push_back(1e3 * static_cast<double>(danced.norm()));
      }
  }

  void add_foot(const PosedFigure& figure, std::size_t d, std::size_t side, const Moment& before,
                const Moment& now) {
    const std::optional<float> sole = shown_[d].sole_W_m(figure, side);
    if (sole) out_.foot_below_mm_max = std::max(out_.foot_below_mm_max, -1e3 * *sole);
    const DancedFoot &foot = now.feet[d][side], &was = before.feet[d][side];
    const auto speed = [&](Vector3f step) {
      step.y() = 0.0f;
      return static_cast<double>(step.norm()) * take_.hz;
    };
    const double danced_m_s = speed(foot.ball_W_m - was.ball_W_m);
    if (foot.lowest_m > kStands_m || danced_m_s > kStands_m_s) return;
    ++out_.standing_moments;
    if (sole) floors_.push_back(1e3 * std::abs(static_cast<double>(*sole)));
    danced_floors_.push_back(1e3 * std::abs(static_cast<double>(foot.lowest_m)));
    danced_slides_.push_back(1e3 * danced_m_s);
    const std::size_t toes = index_of(kToes[side]);
    slides_.push_back(1e3 * speed(now.shown[d].p_WB_m[toes] - before.shown[d].p_WB_m[toes]));
  }

  void add_steps(std::size_t d, const Moment& before, const Moment& now) {
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const Vector3f danced = now.danced[d].p_WB_m[b] - before.danced[d].p_WB_m[b];
      const Vector3f shown = now.shown[d].p_WB_m[b] - before.shown[d].p_WB_m[b];
      const double step_mm = 1e3 * static_cast<double>((shown - danced).norm());
      steps_.push_back(step_mm);
      if (step_mm > out_.joint_step_mm_max) {
        out_.joint_step_mm_max = step_mm;
        out_.joint_step_where = fmt::format("{} {} {:.2f} s", d + 1, kBones[b].name,
                                            static_cast<double>(frame_) / take_.hz);
      }
      out_.joint_step_danced_mm_max =
          std::max(out_.joint_step_danced_mm_max, 1e3 * static_cast<double>(danced.norm()));
    }
  }

  const StageTake& take_;
  std::vector<ShownFigure> shown_;
  std::vector<std::array<Vector3f, 2>> palms_m_;
  StageMeasures out_;
  std::vector<double> gaps_, danced_gaps_, hold_offs_, own_offs_, floors_, danced_floors_, slides_,
      danced_slides_, steps_;
  std::size_t stretched_ = 0, arms_ = 0, frame_ = 0;
};

}  // namespace

StageMeasures measure_stage(const StageTake& take, const StageWear& wear, FigureOptions options) {
  FigurePoser poser(options);
  StageMeter meter(take, wear);
  Moment before, now;
  std::vector<double> costs_us;
  for (std::size_t f = 0; f < take.frames(); ++f) {
    const SceneState scene = scene_of(take, wear, f);
    const auto began = std::chrono::steady_clock::now();
    const std::span<const PosedFigure> figures = poser.pose(scene);
    const std::chrono::duration<double, std::micro> cost = std::chrono::steady_clock::now() - began;
    costs_us.push_back(cost.count() / static_cast<double>(figures.size()));
    now = {};
    for (std::size_t d = 0; d < figures.size(); ++d) {
      const SceneGuest& guest = scene.guests[d];
      forward_kinematics(guest.skeleton, guest.pose, now.danced.emplace_back());
      now.shown.push_back(figures[d].frames);
      now.feet.push_back({danced_foot(guest.skeleton, now.danced[d], 0),
                          danced_foot(guest.skeleton, now.danced[d], 1)});
    }
    meter.add(figures, before, now, f == 0);
    std::swap(before, now);
  }
  StageMeasures measures = meter.take_measures();
  measures.us_per_figure = percentile(costs_us, 0.5).value_or(0.0);
  return measures;
}

StageEval evaluate_stage(const StageTake& take, const StageWear& wear) {
  StageEval eval;
  for (const StageDancer& dancer : take.dancers) eval.dancers.push_back(dancer.name);
  for (const auto& avatar : wear.avatars) eval.avatars.push_back(avatar->name);
  eval.frames = take.frames();
  eval.fitted = measure_stage(take, wear, {});
  eval.plain = measure_stage(take, wear, {false, false, false});
  return eval;
}

}  // namespace dance
