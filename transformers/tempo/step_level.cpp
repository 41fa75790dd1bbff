#include "transformers/tempo/step_level.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Feet that stood earlier say nothing about now.
constexpr Duration kFallsKept = Duration::s(16);
// Both feet that come to stand together are one step; after a longer time it is a pause.
constexpr double kOneStep_s = 0.2;
constexpr double kLongestPause_s = 2.0;
constexpr std::size_t kFewestSteps = 5;
// Steps differ by so much from their tempo; on average by no more than the second.
constexpr double kStepSpread_octaves = 0.25;
constexpr double kMostOff_octaves = 0.12;
// Of the steps, so many more must be of one level than of the other.
constexpr double kClear = 0.1;
// What a dance must have of its best tempo's period at the music's; less than the second is none.
constexpr double kAsPeriodic = 0.8;
constexpr double kLeastPeriodic = 0.05;
// The tempo that is heard and the one that is danced differ by some hundredths.
constexpr double kNearTempo = 0.04, kNearTempoStep = 0.01;
constexpr int kScanBinsPerOctave = 24;
constexpr float kJustSure = 0.5f;

}  // namespace

void StepLevel::forget() {
  period_.forget();
  fall_count_ = step_count_ = 0;
  beats_seen_ = 0;
  tempo_bpm_ = 0.0;
  sure_ = 0.0f;
}

void StepLevel::observe(const Pose& pose, MonoTime now) {
  period_.observe(pose, now);
  const MotionBeats& beats = period_.motion_beats();
  // After a pause it counts anew.
  if (beats.count() < beats_seen_) beats_seen_ = fall_count_ = 0;
  const auto fresh = static_cast<std::size_t>(
      std::min<std::uint64_t>(beats.count() - beats_seen_, MotionBeats::kKept));
  beats_seen_ = beats.count();
  for (std::size_t i = fresh; i-- > 0;) {
    const MotionBeat& beat = beats.newest(i);
    if (!beat.is_foot_fall()) continue;
    fall_count_ = std::min(fall_count_ + 1, kFalls);
    std::move_backward(falls_.begin(), falls_.end() - 1, falls_.end());
    falls_[0] = beat.time;
    // Feet are not always seen to stand in the order of their times.
    for (std::size_t k = 1; k < fall_count_ && falls_[k] > falls_[k - 1]; ++k)
      std::swap(falls_[k], falls_[k - 1]);
  }
}

void StepLevel::take_steps() {
  while (fall_count_ > 0 && period_.newest() - falls_[fall_count_ - 1] > kFallsKept) --fall_count_;
  step_count_ = 0;
  if (fall_count_ == 0) return;
  MonoTime sooner = falls_[fall_count_ - 1];
  for (std::size_t i = fall_count_ - 1; i-- > 0;) {
    const double s = (falls_[i] - sooner).as_seconds();
    if (s < kOneStep_s) continue;
    sooner = falls_[i];
    if (s < kLongestPause_s) steps_s_[step_count_++] = s;
  }
}

StepLevel::Fit StepLevel::fit_of(double step_s) const {
  Fit fit;
  double sum = 0.0;
  for (std::size_t i = 0; i < step_count_; ++i) {
    const double octaves = std::log2(steps_s_[i] / step_s);
    const double away = octaves / kStepSpread_octaves;
    const double weight = std::exp(-0.5 * away * away);
    sum += weight;
    fit.off_octaves += weight * octaves;
  }
  fit.share = sum / static_cast<double>(step_count_);
  fit.off_octaves /= std::max(sum, 1e-9);
  return fit;
}

double StepLevel::best_score() const {
  double best = 0.0;
  const double octaves = std::log2(kFastest_bpm / kSlowest_bpm);
  for (int k = 0; k <= static_cast<int>(kScanBinsPerOctave * octaves); ++k) {
    const double bpm = kSlowest_bpm * std::exp2(static_cast<double>(k) / kScanBinsPerOctave);
    best = std::max(best, static_cast<double>(period_.score_at(bpm)));
  }
  return best;
}

void StepLevel::look_near(double music_bpm) {
  double level_bpm = music_bpm;
  while (level_bpm >= 2.0 * kSlowest_bpm) level_bpm *= 0.5;
  while (level_bpm < kSlowest_bpm) level_bpm *= 2.0;
  double periodic = 0.0, best = 0.0, other = 0.0, best_bpm = 0.0;
  for (; level_bpm <= kFastest_bpm; level_bpm *= 2.0) {
    double share = 0.0;
    for (double part = -kNearTempo; part < kNearTempo + 0.5 * kNearTempoStep;
         part += kNearTempoStep) {
      const double bpm = level_bpm * (1.0 + part);
      periodic = std::max(periodic, static_cast<double>(period_.score_at(bpm)));
      const Fit fit = fit_of(60.0 / bpm);
      if (std::abs(fit.off_octaves) <= kMostOff_octaves) share = std::max(share, fit.share);
    }
    other = std::max(other, std::min(share, best));
    if (share <= best) continue;
    best = share;
    best_bpm = level_bpm;
  }
  if (periodic < kAsPeriodic * best_score() || best - other <= kClear) return;
  tempo_bpm_ = best_bpm;
  sure_ = static_cast<float>(std::min(1.0, kJustSure + best - other));
}

void StepLevel::look_everywhere() {
  const double octaves = std::log2(kFastest_bpm / kSlowest_bpm);
  double best = 0.0;
  for (int k = 0; k <= static_cast<int>(kScanBinsPerOctave * octaves); ++k) {
    const double bpm = kSlowest_bpm * std::exp2(static_cast<double>(k) / kScanBinsPerOctave);
    const double share = fit_of(60.0 / bpm).share;
    const double worth = share * static_cast<double>(period_.score_at(bpm));
    if (worth <= best || share < kClear) continue;
    best = worth;
    tempo_bpm_ = bpm;
    sure_ = static_cast<float>(std::min(1.0, kJustSure + share));
  }
}

void StepLevel::judge(double music_bpm) {
  take_steps();
  tempo_bpm_ = 0.0;
  sure_ = 0.0f;
  if (step_count_ < kFewestSteps || best_score() < kLeastPeriodic) return;
  if (music_bpm > 0.0)
    look_near(music_bpm);
  else
    look_everywhere();
}

}  // namespace dance
