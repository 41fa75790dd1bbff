#include "producers/music/beat_tracker.h"

#include <algorithm>

namespace dance {
namespace {

constexpr float kActivityWeight = 0.01f;  // a hop's part of the last second
// Below so much of the usual activity strokes are believed less, in a silence not at all.
constexpr float kUsualActivity = 0.4f;
constexpr std::int64_t kKnownAfter_hops = 200;
constexpr std::int64_t kSilentAfter_hops = 400;

}  // namespace

BeatTracker::BeatTracker(double sample_rate_hz)
    : onsets_(sample_rate_hz),
      hop_s_(static_cast<double>(onsets_.hop_samples()) / sample_rate_hz),
      pointer_(hop_s_),
      line_(hop_s_),
      hop_(onsets_.hop_samples()) {}

int BeatTracker::push(std::span<const float> samples) {
  int ended = 0;
  while (!samples.empty()) {
    const std::size_t n = std::min(samples.size(), hop_.size() - filled_);
    std::copy_n(samples.begin(), n, hop_.begin() + static_cast<std::ptrdiff_t>(filled_));
    samples = samples.subspan(n);
    filled_ += n;
    if (filled_ < hop_.size()) break;
    filled_ = 0;
    ++ended;
    end_hop();
  }
  return ended;
}

void BeatTracker::end_hop() {
  const OnsetStrength::Strengths strengths = onsets_.push(hop_);
  ++hops_;
  float strokes = 0.0f;
  for (std::size_t g = 0; g + 1 < kOnsetGroups; ++g)
    strokes += strengths[g] / static_cast<float>(kOnsetGroups - 1);
  activity_ += kActivityWeight * (strokes - activity_);
  const float believed = std::min(1.0f, activity_ / kUsualActivity);
  pointer_.push(strengths, believed);

  const double now_s = static_cast<double>(hops_) * hop_s_;
  line_.follow(pointer_, now_s - OnsetStrength::kDelay_s, now_s);
  const bool sounds = believed > 0.1f;
  silent_hops_ = sounds ? 0 : silent_hops_ + 1;
  if (sounds) ++sounding_hops_;
  beat_.time = MonoTime{} + Duration::seconds(now_s);
  beat_.beat_time = MonoTime{} + Duration::seconds(line_.next_s());
  beat_.beat = static_cast<double>(line_.number());
  beat_.tempo_bpm = 60.0 / line_.period_s();
  beat_.confidence = std::clamp(static_cast<float>(line_.certainty()), 0.0f, 1.0f) * believed;
  beat_.playing = sounding_hops_ >= kKnownAfter_hops && silent_hops_ < kSilentAfter_hops;
}

}  // namespace dance
