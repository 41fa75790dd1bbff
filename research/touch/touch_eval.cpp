#include "research/touch/touch_eval.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "core/base/assert.h"
#include "core/codec/pose_codec.h"
#include "core/motion/palm_pull.h"
#include "testing/line/line_arrivals.h"
#include "transformers/touch/stage_touch.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::uint64_t kClock = 1;
constexpr std::size_t kPairs = 4;

// What a stage shows at one moment, and what was danced then.
struct Shown {
  std::array<Pose, 2> danced, shown;
  MonoTime at;
};
using Stage = std::vector<Shown>;

std::vector<Pose> through_codec(const PredictTake& take) {
  const auto encoder = make_pose_encoder(known_codecs().front());
  const auto decoder = make_pose_decoder(known_codecs().front());
  encoder->set_skeleton(take.skeleton);
  decoder->set_skeleton(take.skeleton);
  std::vector<Pose> out;
  std::array<std::uint8_t, kMaxPosePayload> payload{};
  for (const Pose& pose : take.poses) {
    const std::size_t size = encoder->encode(pose, payload);
    Pose decoded = pose;
    const DecodeResult result =
        decoder->decode(pose.sequence, std::span(payload).first(size), decoded);
    DANCE_ASSERT(result == DecodeResult::kPose, size, static_cast<int>(result));
    decoded.sequence = pose.sequence;
    decoded.capture_time = pose.capture_time;
    decoded.clock_id = pose.clock_id;
    out.push_back(decoded);
  }
  return out;
}

Stage captured_stage(const CoupleTake& couple, const std::array<std::vector<Pose>, 2>& poses,
                     Duration warm_up) {
  Stage stage;
  const MonoTime begin = couple[0].poses.front().capture_time + warm_up;
  for (std::size_t i = 0; i < couple[0].poses.size(); ++i)
    if (couple[0].poses[i].capture_time >= begin)
      stage.push_back({{couple[0].poses[i], couple[1].poses[i]},
                       {poses[0][i], poses[1][i]},
                       couple[0].poses[i].capture_time});
  return stage;
}

// The first dancer is here, the second comes over the line and through the route.
Stage streamed_stage(const CoupleTake& couple, const TouchLine& how) {
  Random random(7);
  CoupleTake seen = couple;
  for (PredictTake& take : seen) take.poses = trembling(take.poses, how.noise_deg, random);
  const std::vector<Pose> sent = through_codec(seen[1]);
  LossySpec spec;
  spec.delay = how.delay;
  spec.tail = how.jitter;
  spec.loss = 0.01 * how.loss_percent;
  LossyModel line({.spec = spec}, 1);
  const std::vector<LineArrival> arrivals =
      arrivals_over(line, sent.size(), [&](std::size_t i) { return sent[i].capture_time; });
  auto flow = Flow::make(how.through, how.parts);
  DANCE_ASSERT(flow.has_value());
  PartnerTracks here;
  flow->set_dancers(&here);
  flow->set_body(seen[1].skeleton);
  const auto learner = flow->learner();
  Stage stage;
  std::size_t next = 0;
  Pose newest;
  for (std::size_t i = 0; i < couple[0].poses.size(); ++i) {
    const MonoTime now = couple[0].poses[i].capture_time;
    here.take(*GuestId::parse("lead"), seen[0].poses[i], &seen[0].skeleton);
    for (; next < arrivals.size() && arrivals[next].at <= now; ++next) {
      newest = sent[arrivals[next].index];
      if (!flow->is_pass_through()) flow->observe(newest, arrivals[next].at);
      if (learner && newest.sequence % 20 == 0) learner->learn();
    }
    Pose shown = newest;
    if (!flow->is_pass_through() && !flow->sample(now, shown)) continue;
    if (now - couple[0].poses.front().capture_time >= how.warm_up)
      stage.push_back({{couple[0].poses[i], couple[1].poses[i]}, {seen[0].poses[i], shown}, now});
  }
  return stage;
}

std::array<Vector3f, 2> palms_of(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return {palm_of(skeleton, frames, 0), palm_of(skeleton, frames, 1)};
}

std::array<float, kPairs> gaps_of(const CoupleTake& couple, const std::array<Pose, 2>& poses) {
  const auto lead = palms_of(couple[0].skeleton, poses[0]);
  const auto follow = palms_of(couple[1].skeleton, poses[1]);
  std::array<float, kPairs> gaps{};
  for (std::size_t k = 0; k < kPairs; ++k) gaps[k] = (lead[k / 2] - follow[k % 2]).norm();
  return gaps;
}

// Counts what one way reports, pair of palms by pair.
class HoldCount {
 public:
  void add(const std::array<bool, kPairs>& reported, const std::array<float, kPairs>& danced) {
    for (std::size_t k = 0; k < kPairs; ++k) {
      const bool is_true = danced[k] <= kTruth_m;
      figures_.true_frames += is_true;
      figures_.found_frames += is_true && reported[k];
      figures_.held_frames += reported[k];
      figures_.apart_frames += reported[k] && danced[k] > 2.0f * kTruth_m;
      figures_.true_holds += is_true && !was_true_[k];
      figures_.breaks += is_true && was_true_[k] && was_[k] && !reported[k];
      if (reported[k] && !was_[k]) {
        ++figures_.holds;
        has_truth_[k] = false;
        nearest_m_[k] = danced[k];
      }
      if (reported[k]) {
        has_truth_[k] = has_truth_[k] || is_true;
        nearest_m_[k] = std::min(nearest_m_[k], danced[k]);
      }
      if (was_[k] && !reported[k]) end(k);
      was_[k] = reported[k];
      was_true_[k] = is_true;
    }
  }
  HoldFigures figures(double seconds) {
    for (std::size_t k = 0; k < kPairs; ++k)
      if (was_[k]) end(k);
    figures_.seconds = seconds;
    return figures_;
  }

 private:
  void end(std::size_t k) {
    figures_.false_holds += !has_truth_[k];
    figures_.far_holds += nearest_m_[k] > 1.5f * kTruth_m;
  }
  HoldFigures figures_;
  std::array<float, kPairs> nearest_m_{};
  std::array<bool, kPairs> was_{}, was_true_{}, has_truth_{};
};

HoldFigures sum(HoldFigures a, const HoldFigures& b) {
  a.true_frames += b.true_frames;
  a.found_frames += b.found_frames;
  a.held_frames += b.held_frames;
  a.apart_frames += b.apart_frames;
  a.holds += b.holds;
  a.false_holds += b.false_holds;
  a.far_holds += b.far_holds;
  a.true_holds += b.true_holds;
  a.breaks += b.breaks;
  a.seconds += b.seconds;
  return a;
}

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

Judged judge(const CoupleTake& couple, const Stage& stage, const PalmHold::Limits& limits,
             Gaps& gaps, Costs& costs) {
  const GuestId lead = *GuestId::parse("lead"), follow = *GuestId::parse("follow");
  StageHolds holds;
  holds.set_limits(limits);
  StageTouch touch;
  NoSink no_sink;
  HoldCount plain, ours;
  std::array<std::array<Vector3f, 2>, 2> was_plain, was_reached;
  bool is_first = true;
  for (const Shown& moment : stage) {
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
    std::array<bool, kPairs> near{}, held{};
    for (std::size_t k = 0; k < kPairs; ++k) {
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

double HoldFigures::found() const {
  return true_frames > 0 ? static_cast<double>(found_frames) / static_cast<double>(true_frames)
                         : 0.0;
}

double HoldFigures::per_minute(std::size_t count) const {
  return seconds > 0.0 ? 60.0 * static_cast<double>(count) / seconds : 0.0;
}

TouchEval evaluate_touch(const std::vector<CoupleTake>& couples, const TouchLine& line) {
  constexpr std::array<const char*, 3> kStages{"as captured", "through the codec", "on the stage"};
  TouchEval eval;
  Costs costs;
  for (std::size_t s = 0; s < kStages.size(); ++s) {
    HoldFigures plain, ours;
    Gaps gaps;
    for (const CoupleTake& couple : couples) {
      Stage stage;
      if (s == 0)
        stage = captured_stage(couple, {couple[0].poses, couple[1].poses}, line.warm_up);
      else if (s == 1)
        stage = captured_stage(couple, {through_codec(couple[0]), through_codec(couple[1])},
                               line.warm_up);
      else
        stage = streamed_stage(couple, line);
      if (stage.empty()) continue;
      const Judged judged = judge(couple, stage, line.limits, gaps, costs);
      plain = sum(plain, judged.plain);
      ours = sum(ours, judged.ours);
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
