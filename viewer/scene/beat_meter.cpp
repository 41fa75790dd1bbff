#include "viewer/scene/beat_meter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {
namespace {
constexpr double kTurn = 2.0 * std::numbers::pi;
// A larger step is a jump to another place of the music.
constexpr double kLongestStep_beats = 1.0;
}  // namespace

void BeatMeter::add(double own, double heard, double beats_per_second,
                    std::optional<Duration> delay) {
  if (!std::isfinite(own) || !(beats_per_second > 0.0)) return;
  note_own_beats(own, heard);
  beats_per_second_ = beats_per_second;
  const double angle = kTurn * (heard - own);
  Sample& sample = samples_[count_++ % kSamples];
  sample = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), {}};
  if (delay) sample.delay_ms = static_cast<float>(delay->as_ms());
}

void BeatMeter::note_own_beats(double own, double heard) {
  const double step = own - last_own_;
  if (count_ > 0 && step > 0.0 && step <= kLongestStep_beats) {
    const double beat = std::floor(own);
    if (beat > last_own_) {
      const double share = (beat - last_own_) / step;
      own_beats_[own_beat_count_++ % own_beats_.size()] =
          last_heard_ + share * (heard - last_heard_);
    }
  } else if (count_ > 0 && std::abs(step) > kLongestStep_beats) {
    own_beat_count_ = 0;
  }
  last_own_ = own;
  last_heard_ = heard;
}

std::optional<BeatFigures> BeatMeter::figures() const {
  const std::size_t n = std::min(count_, kSamples);
  if (n < kFewest) return std::nullopt;
  double cosines = 0.0, sines = 0.0, delays_ms = 0.0;
  std::size_t delayed = 0;
  for (std::size_t i = 0; i < n; ++i) {
    cosines += static_cast<double>(samples_[i].cosine);
    sines += static_cast<double>(samples_[i].sine);
    if (!samples_[i].delay_ms) continue;
    delays_ms += static_cast<double>(*samples_[i].delay_ms);
    ++delayed;
  }
  const double beat_ms = 1e3 / beats_per_second_;
  const double length = std::clamp(std::hypot(cosines, sines) / static_cast<double>(n), 1e-6, 1.0);
  BeatFigures figures;
  figures.behind_ms = static_cast<float>(std::atan2(sines, cosines) / kTurn * beat_ms);
  figures.wander_ms =
      static_cast<float>(std::sqrt(std::max(0.0, -2.0 * std::log(length))) / kTurn * beat_ms);
  if (delayed > 0) figures.delay_ms = static_cast<float>(delays_ms / static_cast<double>(delayed));
  figures.own_beat_count = std::min(own_beat_count_, own_beats_.size());
  for (std::size_t i = 0; i < figures.own_beat_count; ++i)
    figures.own_beats[i] =
        own_beats_[(own_beat_count_ - figures.own_beat_count + i) % own_beats_.size()];
  return figures;
}

}  // namespace dance
