#include "producers/music/tracker/beat_tracker.h"

#include <algorithm>

namespace dance {
namespace {

// A hop with a mean strength above this is a stroke.
constexpr float kStroke = 1.0f;
// The slowest beat that is looked for lasts 83 hops. Where no stroke has been for longer the music
// has a break, without evidence of the beat: weights fade from the first to the second.
constexpr std::int64_t kBreakBegins_hops = 65;
constexpr std::int64_t kBreak_hops = 90;
constexpr std::int64_t kKnownAfter_hops = 200;
constexpr std::int64_t kSilentAfter_hops = 400;

}  // namespace

BeatTracker::BeatTracker(double sample_rate_hz, std::shared_ptr<const BeatModel> model)
    : onsets_(sample_rate_hz),
      hop_s_(static_cast<double>(onsets_.hop_samples()) / sample_rate_hz),
      model_(std::move(model)),
      features_(onsets_),
      pointer_(hop_s_, model_->patterns),
      tempo_(hop_s_, pointer_.least_period_hops(),
             pointer_.most_period_hops() - pointer_.least_period_hops() + 1),
      lock_(hop_s_),
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
  since_stroke_hops_ = strokes > kStroke ? 0 : since_stroke_hops_ + 1;
  const float weight = std::clamp(static_cast<float>(kBreak_hops - since_stroke_hops_) /
                                      static_cast<float>(kBreak_hops - kBreakBegins_hops),
                                  0.0f, 1.0f);
  if (features_.push(onsets_, strengths)) meaning_ = model_->net.step(features_.values(), heard_);
  tempo_.push(heard_.tempi, weight);
  pointer_.push(strengths, meaning_, weight, tempo_.of_periods());

  const double now_s = static_cast<double>(hops_) * hop_s_;
  lock_.follow(pointer_, now_s - OnsetStrength::kDelay_s, now_s);
  if (since_stroke_hops_ < kBreak_hops) ++sounding_hops_;
  beat_.time = MonoTime{} + Duration::seconds(now_s);
  beat_.beat_time = MonoTime{} + Duration::seconds(lock_.next_s());
  beat_.beat = static_cast<double>(lock_.number());
  beat_.tempo_bpm = 60.0 / lock_.period_s();
  beat_.confidence = std::clamp(static_cast<float>(lock_.certainty()), 0.0f, 1.0f) * weight;
  beat_.playing = sounding_hops_ >= kKnownAfter_hops && since_stroke_hops_ < kSilentAfter_hops;
}

}  // namespace dance
