#include "research/touch/touch_eval.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "transformers/touch/stage_touch.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::uint64_t kClock = 1;

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

struct Gaps {
  std::vector<double> plain, reached, step_plain, step_reached;
};

struct NoSink final : TouchSink {
  void on_touch(const GuestId&, const Touch&) override {}
};

struct Costs {
  std::vector<double> pose_us, picture_us;
};

struct Judged {
  HoldFigures plain, ours;
};

Judged judge(const CoupleTake& couple, const ShownStage& stage, const PalmHold::Limits& limits,
             Gaps& gaps, Costs& costs) {
  const GuestId lead = *GuestId::parse("lead"), follow = *GuestId::parse("follow");
  StageHolds holds;
  holds.set_limits(limits);
  StageTouch touch;
  NoSink no_sink;
  HoldCount plain, ours;
  std::array<std::array<Vector3f, 2>, 2> was_plain, was_reached;
  bool is_first = true;
  for (const ShownMoment& moment : stage) {
    std::array<Pose, 2> reached = moment.shown;
    if (is_first) {
      holds.show(lead, reached[0], moment.at, true, DancerOf::kThisHouse);
      holds.show(follow, reached[1], moment.at, true, DancerOf::kThisHouse);
      holds.set_body(lead, couple[0].skeleton);
      holds.set_body(follow, couple[1].skeleton);
      reached = moment.shown;
    }
    const auto began = std::chrono::steady_clock::now();
    holds.show(lead, reached[0], moment.at, true, DancerOf::kThisHouse);
    holds.show(follow, reached[1], moment.at, true, DancerOf::kThisHouse);
    const std::chrono::duration<double, std::micro> cost = std::chrono::steady_clock::now() - began;
    costs.pose_us.push_back(0.5 * cost.count());
    touch.show(lead, reached[0], moment.at, DancerOf::kThisHouse);
    touch.show(follow, reached[1], moment.at, DancerOf::kThisHouse);
    const auto looked = std::chrono::steady_clock::now();
    touch.update(moment.at, kClock, holds, no_sink);
    const std::chrono::duration<double, std::micro> look =
        std::chrono::steady_clock::now() - looked;
    costs.picture_us.push_back(look.count());
    const auto danced_gaps = gaps_of(couple, moment.danced);
    const auto shown_gaps = gaps_of(couple, moment.shown);
    const auto reached_gaps = gaps_of(couple, reached);
    std::array<bool, kHandPairs> near{}, held{};
    for (std::size_t k = 0; k < kHandPairs; ++k) {
      near[k] = shown_gaps[k] <= kTruth_m;
      held[k] = holds.are_held(lead, k / 2, follow, k % 2);
      if (danced_gaps[k] > kTruth_m) continue;
      gaps.plain.push_back(1e3 * static_cast<double>(shown_gaps[k]));
      gaps.reached.push_back(1e3 * static_cast<double>(reached_gaps[k]));
    }
    plain.add(near, danced_gaps);
    ours.add(held, danced_gaps);
    for (std::size_t d = 0; d < 2; ++d) {
      const auto now_plain = palms_of(couple[d].skeleton, moment.shown[d]);
      const auto now_reached = palms_of(couple[d].skeleton, reached[d]);
      for (std::size_t side = 0; side < 2 && !is_first; ++side) {
        gaps.step_plain.push_back(
            1e3 * static_cast<double>((now_plain[side] - was_plain[d][side]).norm()));
        gaps.step_reached.push_back(
            1e3 * static_cast<double>((now_reached[side] - was_reached[d][side]).norm()));
      }
      was_plain[d] = now_plain;
      was_reached[d] = now_reached;
    }
    is_first = false;
  }
  const double seconds = static_cast<double>(stage.size()) / couple[0].hz;
  return {plain.figures(seconds), ours.figures(seconds)};
}

}  // namespace

TouchEval evaluate_touch(const std::vector<CoupleTake>& couples, const TouchLine& line) {
  constexpr std::array<const char*, 3> kStages{"as captured", "through the codec", "on the stage"};
  TouchEval eval;
  Costs costs;
  for (std::size_t s = 0; s < kStages.size(); ++s) {
    HoldFigures plain, ours;
    Gaps gaps;
    for (const CoupleTake& couple : couples) {
      ShownStage stage;
      if (s == 0)
        stage = captured_stage(couple, {couple[0].poses, couple[1].poses}, line.warm_up);
      else if (s == 1)
        stage = captured_stage(couple, {through_codec(couple[0]), through_codec(couple[1])},
                               line.warm_up);
      else
        stage = streamed_stage(couple, line);
      if (stage.empty()) continue;
      const Judged judged = judge(couple, stage, line.limits, gaps, costs);
      plain += judged.plain;
      ours += judged.ours;
    }
    eval.rows.push_back({kStages[s], "within 8 cm", plain});
    eval.rows.push_back({kStages[s], "holds", ours});
    eval.gaps.push_back({kStages[s], percentile(gaps.plain, 0.5), percentile(gaps.plain, 0.95),
                         percentile(gaps.reached, 0.5), percentile(gaps.reached, 0.95),
                         percentile(gaps.step_plain, 0.99), percentile(gaps.step_reached, 0.99)});
  }
  eval.us_a_pose = percentile(costs.pose_us, 0.5);
  eval.us_a_picture = percentile(costs.picture_us, 0.5);
  return eval;
}

}  // namespace dance
