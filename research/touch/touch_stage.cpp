#include "research/touch/touch_stage.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"
#include "core/codec/pose_codec.h"
#include "core/motion/palm_pull.h"
#include "testing/line/line_arrivals.h"
#include "transformers/touch/stage_holds.h"

namespace dance {

using Eigen::Vector3f;

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

ShownStage captured_stage(const CoupleTake& couple, const std::array<std::vector<Pose>, 2>& poses,
                          Duration warm_up) {
  ShownStage stage;
  const MonoTime begin = couple[0].poses.front().capture_time + warm_up;
  for (std::size_t i = 0; i < couple[0].poses.size(); ++i)
    if (couple[0].poses[i].capture_time >= begin)
      stage.push_back({{couple[0].poses[i], couple[1].poses[i]},
                       {poses[0][i], poses[1][i]},
                       couple[0].poses[i].capture_time});
  return stage;
}

ShownStage streamed_stage(const CoupleTake& couple, const TouchLine& how) {
  Random random(7 + how.seed);
  CoupleTake seen = couple;
  for (PredictTake& take : seen) take.poses = trembling(take.poses, how.noise_deg, random);
  const std::vector<Pose> sent = through_codec(seen[1]);
  LossySpec spec;
  spec.delay = how.delay;
  spec.tail = how.jitter;
  spec.loss = 0.01 * how.loss_percent;
  LossyModel line({.spec = spec}, 1 + how.seed);
  const std::vector<LineArrival> arrivals =
      arrivals_over(line, sent.size(), [&](std::size_t i) { return sent[i].capture_time; });
  auto flow = Flow::make(how.through, how.parts);
  DANCE_ASSERT(flow.has_value());
  PartnerTracks here;
  flow->set_dancers(&here);
  flow->set_body(seen[1].skeleton);
  const auto learner = flow->learner();
  ShownStage stage;
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

PalmGaps gaps_of(const CoupleTake& couple, const std::array<Pose, 2>& poses) {
  const auto lead = palms_of(couple[0].skeleton, poses[0]);
  const auto follow = palms_of(couple[1].skeleton, poses[1]);
  PalmGaps gaps{};
  for (std::size_t k = 0; k < kHandPairs; ++k) gaps[k] = (lead[k / 2] - follow[k % 2]).norm();
  return gaps;
}

void HoldCount::add(const std::array<bool, kHandPairs>& reported, const PalmGaps& danced) {
  for (std::size_t k = 0; k < kHandPairs; ++k) {
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

HoldFigures HoldCount::figures(double seconds) {
  for (std::size_t k = 0; k < kHandPairs; ++k)
    if (was_[k]) end(k);
  figures_.seconds = seconds;
  return figures_;
}

void HoldCount::end(std::size_t k) {
  figures_.false_holds += !has_truth_[k];
  figures_.far_holds += nearest_m_[k] > 1.5f * kTruth_m;
}

HoldFigures holds_on(const CoupleTake& couple, const ShownStage& stage,
                     const PalmHold::Limits& limits) {
  const GuestId lead = *GuestId::parse("lead"), follow = *GuestId::parse("follow");
  StageHolds holds;
  holds.set_limits(limits);
  HoldCount count;
  bool is_first = true;
  for (const ShownMoment& moment : stage) {
    std::array<Pose, 2> shown = moment.shown;
    const auto show = [&] {
      holds.show(lead, shown[0], moment.at, false, DancerOf::kThisHouse);
      holds.show(follow, shown[1], moment.at, false, DancerOf::kThisHouse);
    };
    show();
    if (std::exchange(is_first, false)) {
      // A dancer has a body once it has a place.
      holds.set_body(lead, couple[0].skeleton);
      holds.set_body(follow, couple[1].skeleton);
      show();
    }
    std::array<bool, kHandPairs> held{};
    for (std::size_t k = 0; k < kHandPairs; ++k)
      held[k] = holds.are_held(lead, k / 2, follow, k % 2);
    count.add(held, gaps_of(couple, moment.danced));
  }
  return count.figures(static_cast<double>(stage.size()) / couple[0].hz);
}

HoldFigures near_on(const CoupleTake& couple, const ShownStage& stage) {
  HoldCount count;
  for (const ShownMoment& moment : stage) {
    const PalmGaps shown = gaps_of(couple, moment.shown);
    std::array<bool, kHandPairs> near{};
    for (std::size_t k = 0; k < kHandPairs; ++k) near[k] = shown[k] <= kTruth_m;
    count.add(near, gaps_of(couple, moment.danced));
  }
  return count.figures(static_cast<double>(stage.size()) / couple[0].hz);
}

double HoldFigures::found() const {
  return true_frames > 0 ? static_cast<double>(found_frames) / static_cast<double>(true_frames)
                         : 0.0;
}

double HoldFigures::apart() const {
  return held_frames > 0 ? static_cast<double>(apart_frames) / static_cast<double>(held_frames)
                         : 0.0;
}

double HoldFigures::per_minute(std::size_t count) const {
  return seconds > 0.0 ? 60.0 * static_cast<double>(count) / seconds : 0.0;
}

HoldFigures& HoldFigures::operator+=(const HoldFigures& more) {
  true_frames += more.true_frames;
  found_frames += more.found_frames;
  held_frames += more.held_frames;
  apart_frames += more.apart_frames;
  holds += more.holds;
  false_holds += more.false_holds;
  far_holds += more.far_holds;
  true_holds += more.true_holds;
  breaks += more.breaks;
  seconds += more.seconds;
  return *this;
}

}  // namespace dance
