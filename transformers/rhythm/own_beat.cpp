#include "transformers/rhythm/own_beat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

// The filter's word is taken from the first of these on, down to the second, and for a little while
// longer: a figure hides the steps, the dancer goes on.
constexpr float kSure = 0.9f, kNoLongerSure = 0.6f;
constexpr Duration kGoesOn = Duration::s(1);
// What it says a little differently is weighed; what is another place is jumped to
// when it has said so for a while.
constexpr double kJump_counts = 0.5;
constexpr Duration kBelievesJump = Duration::ms(1500);
// Steps are looked for at the music's tempo. Where the period hears them steady at another one, and
// the filter has not been sure for a while, it looks for them there, as long as it finds them.
constexpr double kOtherTempo = 0.04;
constexpr Duration kLooksElsewhere = Duration::s(6);

// Steady is what has been like itself for a few seconds; it may waver a little before it no longer
// is.
constexpr double kSteady = 0.6, kNoLonger = 0.45;
constexpr double kSteadinessTaken = 0.01;  // per pose: one to two seconds
constexpr double kPlaceTaken = 0.004;
// What the stage's play rate can make of it.
constexpr double kMostStretch = 1.15;

bool can_be_danced(double music_bpm, double steps_bpm) {
  const double stretch = music_bpm / steps_bpm;
  return stretch < kMostStretch && stretch > 1.0 / kMostStretch;
}

}  // namespace

void OwnBeat::forget() {
  period_.forget();
  signs_.forget();
  pointer_.forget();
  is_sure_ = false;
  own_bpm_ = 0.0;
  seen_ = sure_ = looked_ = MonoTime();
  place_ = 0.0;
  steadiness_ = 0.0;
  is_steady_ = false;
}

std::optional<double> OwnBeat::observe(const Pose& pose, MonoTime now, double music_bpm) {
  period_.observe(pose, now);
  if (period_.newest() != seen_) follow_steps(music_bpm);
  const std::optional<double> steady = by_period(pose.capture_time, music_bpm);
  if (!is_sure_) return steady;
  const double since_s = (pose.capture_time - told_at_).as_seconds();
  return (told_.counts() + told_.counts_per_s() * since_s) / pointer_.counts_per_beat();
}

double OwnBeat::steps_bpm(double music_bpm, MonoTime t) {
  if (is_sure_) looked_ = t;
  if (t - looked_ > kLooksElsewhere) {
    looked_ = t;
    const double steady_bpm = is_steady_ ? period_.tempo_bpm() * beats_per_step_ : music_bpm;
    const bool is_other = std::abs(steady_bpm / music_bpm - 1.0) > kOtherTempo;
    if (is_other || own_bpm_ > 0.0) pointer_.forget();
    own_bpm_ = is_other ? steady_bpm : 0.0;
  }
  return own_bpm_ > 0.0 ? own_bpm_ : music_bpm;
}

void OwnBeat::follow_steps(double music_bpm) {
  seen_ = period_.newest();
  const std::size_t slots = signs_.add(period_.frame());
  if (signs_.has_begun_anew()) {
    pointer_.forget();
    is_sure_ = false;
    looked_ = seen_;
  }
  if (!(music_bpm > 0.0)) return;
  if (own_bpm_ > 0.0 && !can_be_danced(music_bpm, own_bpm_)) {
    pointer_.forget();
    is_sure_ = false;
    own_bpm_ = 0.0;
  }
  for (std::size_t i = 0; i < slots; ++i) {
    const double counts_per_beat = pointer_.counts_per_beat();
    const MonoTime t = signs_.slot(i).middle;
    pointer_.add(signs_.slot(i), steps_bpm(music_bpm, t));
    if (pointer_.sureness() > (is_sure_ ? kNoLongerSure : kSure)) sure_ = t;
    const bool was_sure = is_sure_ && counts_per_beat == pointer_.counts_per_beat();
    is_sure_ = sure_ == t || (was_sure && t - sure_ < kGoesOn);
    if (!is_sure_) continue;
    if (was_sure) told_.go_on((t - told_at_).as_seconds());
    told_at_ = t;
    // A doubtful word is not listened to.
    if (was_sure && sure_ != t) continue;
    double ahead = pointer_.counts(t) - told_.counts();
    ahead -= 4.0 * std::round(ahead / 4.0);
    const bool is_elsewhere = std::abs(ahead) > kJump_counts;
    if (!is_elsewhere) near_ = t;
    if (!was_sure || t - near_ > kBelievesJump) {
      told_.begin(told_.counts() + ahead, pointer_.tempo_bpm() / 60.0);
      near_ = t;
    } else if (!is_elsewhere) {
      told_.hear(ahead);
    }
  }
}

std::optional<double> OwnBeat::by_period(MonoTime t, double music_bpm) {
  if (!period_.is_known() || !period_.is_anchored()) {
    steadiness_ = 0.0;
    is_steady_ = false;
    return std::nullopt;
  }
  steadiness_ += kSteadinessTaken * (static_cast<double>(period_.coherence()) - steadiness_);
  const double steps = period_.beats(t);
  const double between = period_.count(t) - steps;
  place_ += kPlaceTaken * (std::polar(1.0, 2.0 * std::numbers::pi * between) - place_);
  if (!is_steady_) {
    // A step to a beat, or one to two, or two to one.
    const double ratio = music_bpm / period_.tempo_bpm();
    beats_per_step_ = std::exp2(std::round(std::log2(ratio)));
  }
  const bool can_be = can_be_danced(music_bpm, period_.tempo_bpm() * beats_per_step_);
  is_steady_ = can_be && steadiness_ > (is_steady_ ? kNoLonger : kSteady);
  if (!is_steady_) return std::nullopt;
  return beats_per_step_ * (steps + std::arg(place_) / (2.0 * std::numbers::pi));
}

}  // namespace dance
