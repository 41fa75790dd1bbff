#include "transformers/rhythm/own_beat.h"

#include <cmath>
#include <numbers>

namespace dance {
namespace {

// Steady is what has been like itself for a few seconds; it may waver a little before it no longer
// is.
constexpr double kSteady = 0.6, kNoLonger = 0.45;
constexpr double kSteadinessTaken = 0.01;  // per pose: one to two seconds
constexpr double kPlaceTaken = 0.004;
// What the stage's play rate can make of it.
constexpr double kMostStretch = 1.15;

}  // namespace

void OwnBeat::forget() {
  period_.forget();
  place_ = 0.0;
  steadiness_ = 0.0;
  is_steady_ = false;
}

std::optional<double> OwnBeat::observe(const Pose& pose, MonoTime now, double music_bpm) {
  period_.observe(pose, now);
  if (!period_.is_known() || !period_.is_anchored()) {
    steadiness_ = 0.0;
    is_steady_ = false;
    return std::nullopt;
  }
  steadiness_ += kSteadinessTaken * (static_cast<double>(period_.coherence()) - steadiness_);
  const double steps = period_.beats(pose.capture_time);
  const double between = period_.count(pose.capture_time) - steps;
  place_ += kPlaceTaken * (std::polar(1.0, 2.0 * std::numbers::pi * between) - place_);
  if (!is_steady_) {
    // A step to a beat, or one to two, or two to one.
    const double ratio = music_bpm / period_.tempo_bpm();
    beats_per_step_ = std::exp2(std::round(std::log2(ratio)));
  }
  const double stretch = music_bpm / (period_.tempo_bpm() * beats_per_step_);
  const bool can_be = stretch < kMostStretch && stretch > 1.0 / kMostStretch;
  is_steady_ = can_be && steadiness_ > (is_steady_ ? kNoLonger : kSteady);
  if (!is_steady_) return std::nullopt;
  return beats_per_step_ * (steps + std::arg(place_) / (2.0 * std::numbers::pi));
}

}  // namespace dance
