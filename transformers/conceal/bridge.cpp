#include "transformers/conceal/bridge.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/pose/interpolate.h"

namespace dance {
namespace {

constexpr std::size_t kBridgedPoses = 1536;
// A line whose delay is long is no silent line.
constexpr Duration kSilentLine = Duration::ms(120);
// Where the station before only repeats its last pose, there is nothing to wait for but jitter.
constexpr Duration kRepeated = Duration::ms(60);
// So far into the fade from what is predicted to what is continued both stand and face alike: a
// fade between two places far apart would be faster than a dancer.
constexpr Duration kMeet = Duration::ms(100);
constexpr Duration kBackInTime = Duration::s(1);

}  // namespace

Bridge::Bridge(const BridgeOptions& options)
    : history_(kBridgedPoses), finish_(options.blend), skeleton_(average_skeleton()) {}

void Bridge::set_body(const Skeleton& skeleton) {
  if (!is_valid(skeleton)) return;
  skeleton_ = skeleton;
  finish_.set_body(skeleton);
}

void Bridge::hear(const Beat& beat, MonoTime /*now*/) {
  if (is_valid(beat)) music_.hear(beat);
}

Duration Bridge::beat(MonoTime now) const {
  return music_.is_known(now) ? music_.period() : Duration();
}

void Bridge::end_lapse() {
  turn_ = identity_rotations();
  continuation_.end();
  comes_back_ = false;
}

void Bridge::observe(const Pose& pose, MonoTime now) {
  if (!history_.empty()) {
    const Pose& newest = history_.newest();
    if (pose.clock_id != newest.clock_id || pose.capture_time < newest.capture_time - kBackInTime) {
      ++counters_.restarts;
      history_.clear();
      finish_.clear();
      end_lapse();
    }
  }
  if (!history_.push(pose)) return;  // the station before counts it
  heard_ = now;
  finish_.observe(pose, now);
  // The continuation is asked once more, for what it would have shown.
  comes_back_ = continuation_.is_running();
}

bool Bridge::is_lapse(MonoTime moment, MonoTime now, bool is_repeated) const {
  if (history_.empty()) return false;
  return moment - history_.newest().capture_time >
             (is_repeated ? kRepeated : Continuation::kPredictedUntil) &&
         now - heard_ > (is_repeated ? kRepeated : kSilentLine);
}

Pose Bridge::mix(const Pose& guess, const Pose& continued, float share) {
  Pose out = interpolate(guess, continued, share);
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    Eigen::Quaternionf turn = continued.R_PB[b] * guess.R_PB[b].conjugate();
    if (turn.dot(turn_[b]) < 0.0f) turn.coeffs() *= -1.0f;
    turn_[b] = turn;
    const float sine = turn.vec().norm();
    if (sine < 1e-4f) continue;
    const float angle = 2.0f * std::atan2(sine, turn.w());
    out.R_PB[b] = exp_rotation(turn.vec() * (share * angle / sine)) * guess.R_PB[b];
  }
  return out;
}

void Bridge::carry_on(MonoTime moment, bool has_input, Pose& pose) {
  const Duration since = moment - continuation_.newest_time();
  Pose continued;
  if (!continuation_.at(since, continued)) return;
  // From nothing on, however late the lapse was noticed.
  const float share =
      has_input && fades_in_
          ? Continuation::share_at(since - lapse_after_ + Continuation::kPredictedUntil)
          : 1.0f;
  if (share <= 0.0f) return;
  const double beats = pose.music_beats;
  pose = share >= 1.0f ? continued : mix(pose, continued, share);
  pose.capture_time = moment;
  pose.music_beats = beats;
}

bool Bridge::sample(MonoTime now, Pose& out) {
  const MonoTime wanted = moment(now);
  bool has_input = input_ && input_->sample(now, out);
  if (history_.empty()) return has_input;
  if (!input_) {
    out = history_.newest();
    has_input = true;
  }
  if (comes_back_) {
    Pose was = out;
    carry_on(wanted, has_input, was);
    finish_.correct(now, was, out);
    end_lapse();
  }
  const bool is_repeated = out.capture_time <= history_.newest().capture_time;
  if (!continuation_.is_running() && is_lapse(wanted, now, is_repeated)) {
    lapse_after_ = wanted - history_.newest().capture_time;
    continuation_.begin(history_, skeleton_, beat(now));
    fades_in_ = !is_repeated;
    if (fades_in_) continuation_.put(lapse_after_ + kMeet, out);
    // What stands begins to move.
    if (Pose continued = out; is_repeated) {
      carry_on(wanted, has_input, continued);
      finish_.correct(now, out, continued);
    }
  }
  const bool is_guess = continuation_.is_running() || !is_repeated;
  if (continuation_.is_running()) carry_on(wanted, has_input, out);
  finish_.apply(now, out, is_guess);
  return true;
}

bool Bridge::sample_at(MonoTime moment, MonoTime now, Pose& out) {
  const bool has_input = input_ && input_->sample_at(moment, now, out);
  if (comes_back_) end_lapse();
  if (history_.empty() || moment <= history_.newest().capture_time) return has_input;
  if (!continuation_.is_running() && is_lapse(moment, now, !has_input)) {
    // Of the dance's time, as all that is shown here: how late the line is says nothing about it.
    lapse_after_ = std::max(Continuation::kPredictedUntil, moment - history_.newest().capture_time);
    fades_in_ = has_input;
    continuation_.begin(history_, skeleton_, beat(now));
    if (fades_in_) continuation_.put(lapse_after_ + kMeet, out);
  }
  if (!continuation_.is_running()) return has_input;
  if (!has_input) out = history_.newest();
  carry_on(moment, has_input, out);
  return true;
}

}  // namespace dance
