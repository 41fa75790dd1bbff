#include "transformers/conceal/concealment.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/pose/interpolate.h"

namespace dance {
namespace {

// A line whose delay is long is no silent line.
constexpr Duration kSilentLine = Duration::ms(120);
// Where the newest pose is only repeated, there is nothing to wait for but jitter.
constexpr Duration kRepeated = Duration::ms(60);
// So far into the fade from what is predicted to what is continued both stand and face alike: a
// fade between two places far apart would be faster than a dancer.
constexpr Duration kMeet = Duration::ms(100);

Duration beat_of(const DancerTimeline& timeline, MonoTime now) {
  return timeline.music().is_known(now) ? timeline.music().period() : Duration();
}

}  // namespace

bool Concealment::is_lapse(const DancerTimeline& timeline, MonoTime moment, MonoTime now,
                           bool is_predicted) {
  return moment - timeline.newest().capture_time >
             (is_predicted ? Continuation::kPredictedUntil : kRepeated) &&
         now - timeline.arrived() > (is_predicted ? kSilentLine : kRepeated);
}

void Concealment::begin(const DancerTimeline& timeline, MonoTime now) {
  fades_in_ = false;
  continuation_.begin(timeline.poses(), timeline.body(), beat_of(timeline, now));
}

void Concealment::begin_with(const DancerTimeline& timeline, MonoTime now, Duration after,
                             const Pose& meets) {
  begin(timeline, now);
  fades_in_ = true;
  lapse_after_ = after;
  continuation_.put(after + kMeet, meets);
}

void Concealment::end() {
  continuation_.end();
  turn_ = identity_rotations();
}

void Concealment::mix(const Pose& predicted, const Pose& continued, float share, Pose& out) {
  out = interpolate(predicted, continued, share);
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    Eigen::Quaternionf turn = continued.R_PB[b] * predicted.R_PB[b].conjugate();
    if (turn.dot(turn_[b]) < 0.0f) turn.coeffs() *= -1.0f;
    turn_[b] = turn;
    const float sine = turn.vec().norm();
    if (sine < 1e-4f) continue;
    const float angle = 2.0f * std::atan2(sine, turn.w());
    out.R_PB[b] = exp_rotation(turn.vec() * (share * angle / sine)) * predicted.R_PB[b];
  }
}

void Concealment::mix_into(MonoTime moment, Pose& pose) {
  const Duration since = moment - continuation_.newest_time();
  // From nothing on, however late the lapse was noticed.
  const float share =
      fades_in_ ? Continuation::share_at(since - lapse_after_ + Continuation::kPredictedUntil)
                : 1.0f;
  Pose continued;
  if (share <= 0.0f || !continuation_.at(since, continued)) return;
  const double beats = pose.music_beats;
  if (share < 1.0f) {
    const Pose predicted = pose;
    mix(predicted, continued, share, pose);
  } else {
    pose = continued;
  }
  pose.capture_time = moment;
  pose.music_beats = beats;
}

}  // namespace dance
