#include "transformers/conceal/continuation.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// A shorter one is not a step that repeats but a trembling.
constexpr Duration kShortestLag = Duration::ms(1000);
// The dancer's own difference to their past, and what is left where stretches meet.
constexpr Duration kFirstHalfLife = Duration::ms(300);
constexpr Duration kWrapHalfLife = Duration::ms(110);
// A speed is of so much time: noise of a sensor must not throw a limb.
constexpr Duration kSpeedOver = Duration::ms(70);
constexpr float kFastestStartTurn_rad_s = 12.0f;
constexpr float kFastestStart_m_s = 2.5f;
// Counts that dances repeat in, and how much worse than the best match one may be.
constexpr std::array<int, 3> kCounts{8, 4, 16};
constexpr double kTempoTolerance = 0.04;
// Nobody leaves the stage: so far from where they were is free, and nobody gets further than both
// together.
constexpr float kFree_m = 0.7f;
constexpr float kBeyond_m = 0.6f;
constexpr Duration kEaseEvery = Duration::ms(150);

Vector3f limited(const Vector3f& v, float most) {
  const float size = v.norm();
  return size > most ? Vector3f(v * (most / size)) : v;
}

float wrapped(float angle_rad) { return std::remainder(angle_rad, 6.2831853f); }

}  // namespace

float Continuation::share_at(Duration since_newest) {
  return static_cast<float>(smooth_step((since_newest - kPredictedUntil).as_seconds() /
                                        (kContinuedFrom - kPredictedUntil).as_seconds()));
}

bool Continuation::begin(const PoseHistory& history, const Skeleton& skeleton, Duration beat) {
  end();
  if (history.empty()) return false;
  history_ = &history;
  newest_ = history.newest();
  match_.look(history, skeleton);
  find_lags(beat);
  make_segments();
  find_ease(skeleton);
  find_places();
  return true;
}

void Continuation::put(Duration since_newest, const Pose& there) {
  if (!history_) return;
  const Pose here = dance_at(since_newest);
  const float yaw_rad = wrapped(heading_rad(there.R_PB[0]) - heading_rad(here.R_PB[0]));
  const Quaternionf turn = about_up(yaw_rad);
  Vector3f shift_m = there.p_WH_m - turn * here.p_WH_m;
  shift_m.y() = 0.0f;
  for (std::size_t i = 0; i < segment_count_; ++i) {
    Segment& segment = segments_[i];
    segment.yaw_rad = wrapped(segment.yaw_rad + yaw_rad);
    segment.shift_m = turn * segment.shift_m + shift_m;
    // Springs of the hips are in W.
    for (Spring* spring : {&segment.place, &segment.turn[0]}) {
      spring->offset = turn * spring->offset;
      spring->velocity = turn * spring->velocity;
    }
  }
  find_places();
}

void Continuation::find_lags(Duration beat) {
  lag_ = loop_ = Duration();
  const auto match = match_.best(kShortestLag, HistoryMatch::kLookBack);
  if (!match) return;
  lag_ = match->lag;
  if (beat == Duration()) {
    const Pose& first = history_->oldest();
    const double beats = newest_.music_beats - first.music_beats;
    // Also false for NaN.
    if (beats > 1.0)
      beat = Duration::seconds((newest_.capture_time - first.capture_time).as_seconds() / beats);
  }
  if (beat < Duration::ms(150) || beat > Duration::s(3)) return;
  float least = 0.0f;
  for (const int count : kCounts) {
    const Duration bars = beat * count;
    const Duration near = Duration::seconds(bars.as_seconds() * kTempoTolerance);
    const auto found = match_.best(bars - near, bars + near);
    if (!found || (loop_ != Duration() && found->distance >= least)) continue;
    // The motion may fit best beside the beat; the loop is on it.
    loop_ = bars;
    least = 0.7f * found->distance;  // a later one must be better by more than a little
  }
}

void Continuation::add_segment(Duration begin, Duration lag, Duration half_life) {
  if (segment_count_ == kMostSegments) return;
  Segment& segment = segments_[segment_count_];
  segment = Segment();
  segment.begin = begin;
  segment.y = Spring::y_of_half_life(half_life);
  // The moment is moved back by whole lags, until it lies in the past.
  Duration back = begin - lag;
  while (lag > Duration() && back >= Duration()) back -= lag;
  segment.source = newest_.capture_time + back;
  segment.stands = lag == Duration();
  // What was shown so far, and how fast it moved.
  const auto before = [&](Duration since) {
    if (segment_count_ == 0) return history_->at(newest_.capture_time + since)->pose;
    return dance_at(segment_count_ - 1, since);
  };
  const Pose was = before(begin), was_before = before(begin - kSpeedOver);
  ++segment_count_;
  const Pose raw = dance_at(segment_count_ - 1, begin);
  segment.yaw_rad = wrapped(heading_rad(was.R_PB[0]) - heading_rad(raw.R_PB[0]));
  const Quaternionf turn = about_up(segment.yaw_rad);
  segment.shift_m = was.p_WH_m - turn * raw.p_WH_m;
  segment.shift_m.y() = 0.0f;
  const Pose is = dance_at(segment_count_ - 1, begin);
  const Pose is_before = dance_at(segment_count_ - 1, begin - kSpeedOver);
  const auto per_s = static_cast<float>(1.0 / kSpeedOver.as_seconds());
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    segment.turn[b].offset = rotation_vector(was.R_PB[b] * is.R_PB[b].conjugate());
    const Vector3f was_turn = rotation_vector(was.R_PB[b] * was_before.R_PB[b].conjugate());
    const Vector3f is_turn = rotation_vector(is.R_PB[b] * is_before.R_PB[b].conjugate());
    segment.turn[b].velocity = limited(per_s * (was_turn - is_turn), kFastestStartTurn_rad_s);
  }
  segment.place.offset = was.p_WH_m - is.p_WH_m;
  segment.place.velocity =
      limited(per_s * ((was.p_WH_m - was_before.p_WH_m) - (is.p_WH_m - is_before.p_WH_m)),
              kFastestStart_m_s);
}

void Continuation::make_segments() {
  segment_count_ = 0;
  add_segment(Duration(), lag_, kFirstHalfLife);
  if (lag_ == Duration()) return;
  // Whole lags, until the loop begins if there is one.
  Duration next = lag_;
  const Duration until = loop_ > Duration() ? kLoopedFrom : kLongest;
  for (; next < until; next += lag_) add_segment(next, lag_, kWrapHalfLife);
  if (loop_ == Duration()) return;
  add_segment(kLoopedFrom, loop_, kWrapHalfLife);
  next = loop_;
  while (next <= kLoopedFrom) next += loop_;
  for (; next < kLongest; next += loop_) add_segment(next, loop_, kWrapHalfLife);
}

std::size_t Continuation::segment_at(Duration since) const {
  std::size_t segment = segment_count_ - 1;
  while (segment > 0 && segments_[segment].begin > since) --segment;
  return segment;
}

Pose Continuation::dance_at(std::size_t index, Duration since) const {
  const Segment& segment = segments_[index];
  const Duration into = since - segment.begin;
  Pose pose = segment.stands ? newest_ : history_->at(segment.source + into)->pose;
  const Quaternionf turn = about_up(segment.yaw_rad);
  pose.R_PB[0] = turn * pose.R_PB[0];
  pose.p_WH_m = turn * pose.p_WH_m + segment.shift_m;
  if (into < Duration()) return pose;
  const auto seconds = static_cast<float>(into.as_seconds());
  // One fade for all: their y is the same.
  const float fade = std::exp(-segment.y * seconds);
  const auto left = [&](const Spring& spring) -> Vector3f {
    return fade * (spring.offset + seconds * (spring.velocity + segment.y * spring.offset));
  };
  pose.p_WH_m += left(segment.place);
  if (fade < 1e-5f) return pose;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    pose.R_PB[b] = exp_rotation(left(segment.turn[b])) * pose.R_PB[b];
  return pose;
}

Pose Continuation::dance_at(Duration since) const { return dance_at(segment_at(since), since); }

void Continuation::find_ease(const Skeleton& skeleton) {
  // The slow mean of each joint: quaternions of one hemisphere added up.
  std::array<Eigen::Vector4f, kBoneCount> sums;
  sums.fill(Eigen::Vector4f::Zero());
  MonoTime next = newest_.capture_time;
  for (std::size_t back = 0; back < history_->size(); ++back) {
    const Pose& pose = history_->newest(back);
    if (pose.capture_time > next) continue;
    if (newest_.capture_time - pose.capture_time > HistoryMatch::kLookBack) break;
    next = pose.capture_time - kEaseEvery;
    const Quaternionf upright = about_up(-heading_rad(pose.R_PB[0]));
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const Quaternionf q = b == 0 ? upright * pose.R_PB[0] : pose.R_PB[b];
      const Quaternionf to = b == 0 ? Quaternionf::Identity() : newest_.R_PB[b];
      sums[b] += q.dot(to) < 0.0f ? Eigen::Vector4f(-q.coeffs()) : q.coeffs();
    }
  }
  ease_ = newest_;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (sums[b].norm() > 1e-3f) ease_.R_PB[b] = Quaternionf(Eigen::Vector4f(sums[b].normalized()));
  ease_.R_PB[0] = about_up(-heading_rad(ease_.R_PB[0])) * ease_.R_PB[0];
  ease_.p_WH_m = Vector3f(0.0f, newest_.p_WH_m.y(), 0.0f);
  // The mean of standing and lifted feet floats: down to the floor.
  BodyFrames frames;
  forward_kinematics(skeleton, ease_, frames);
  ease_.p_WH_m.y() += match_.floor_m() - std::min(frames.position(Bone::kLeftToes).y(),
                                                  frames.position(Bone::kRightToes).y());
}

void Continuation::find_places() {
  const Duration step = (kCalmFrom - kCalmingFrom) / static_cast<std::int64_t>(kCalmSteps);
  Pose before = dance_at(kCalmingFrom);
  bound(before);
  places_[0] = {heading_rad(before.R_PB[0]), before.p_WH_m};
  for (std::size_t i = 1; i <= kCalmSteps; ++i) {
    Pose pose = dance_at(kCalmingFrom + step * static_cast<std::int64_t>(i));
    bound(pose);
    const float share =
        1.0f -
        static_cast<float>(smooth_step(static_cast<double>(i) / static_cast<double>(kCalmSteps)));
    places_[i].yaw_rad = places_[i - 1].yaw_rad +
                         share * wrapped(heading_rad(pose.R_PB[0]) - heading_rad(before.R_PB[0]));
    places_[i].p_m = places_[i - 1].p_m + share * (pose.p_WH_m - before.p_WH_m);
    before = pose;
  }
}

void Continuation::bound(Pose& pose) const {
  const Vector3f& home = newest_.p_WH_m;
  Vector3f away = pose.p_WH_m - home;
  away.y() = 0.0f;
  const float distance_m = away.norm();
  if (distance_m <= kFree_m) return;
  const float bounded_m = kFree_m - kBeyond_m * std::expm1((kFree_m - distance_m) / kBeyond_m);
  pose.p_WH_m += away * (bounded_m / distance_m - 1.0f);
}

void Continuation::calm(Duration since, Pose& pose) const {
  const double x = (since - kCalmingFrom).as_seconds() / (kCalmFrom - kCalmingFrom).as_seconds();
  const auto share = static_cast<float>(smooth_step(x));
  const double at = std::clamp(x, 0.0, 1.0) * static_cast<double>(kCalmSteps);
  const auto i = std::min(static_cast<std::size_t>(at), kCalmSteps - 1);
  const auto between = static_cast<float>(at - static_cast<double>(i));
  const float yaw_rad =
      places_[i].yaw_rad + between * (places_[i + 1].yaw_rad - places_[i].yaw_rad);
  const Vector3f p_m = places_[i].p_m + between * (places_[i + 1].p_m - places_[i].p_m);
  const Quaternionf tilt = about_up(-heading_rad(pose.R_PB[0])) * pose.R_PB[0];
  pose.R_PB[0] = about_up(yaw_rad) * tilt.slerp(share, ease_.R_PB[0]);
  for (std::size_t b = 1; b < kBoneCount; ++b)
    pose.R_PB[b] = pose.R_PB[b].slerp(share, ease_.R_PB[b]);
  const float height_m = pose.p_WH_m.y() + share * (ease_.p_WH_m.y() - pose.p_WH_m.y());
  pose.p_WH_m = Vector3f(p_m.x(), height_m, p_m.z());
}

bool Continuation::at(Duration since_newest, Pose& out) const {
  if (!history_) return false;
  const Duration since = std::clamp(since_newest, Duration(), kLongest);
  out = dance_at(since);
  bound(out);
  if (since > kCalmingFrom) calm(since, out);
  normalize(out);
  // Of the newest pose in all but what is predicted.
  out.presence = newest_.presence;
  out.confidence = newest_.confidence;
  out.sequence = newest_.sequence;
  out.clock_id = newest_.clock_id;
  out.capture_time = newest_.capture_time + since_newest;
  out.hops = newest_.hops;
  out.music_beats = kNoMusic;
  return true;
}

}  // namespace dance
