#include "producers/music/tracker/tempo/tempo_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/beat.h"

namespace dance {
namespace {

// How fast a level that is likelier than its half or double gains on it, each hop: in less than a
// second, once it is clear, and the last seconds' rhythm changes slowly.
constexpr float kRhythmEvidence = 0.1f;
// A hint of weight 1 outweighs whatever the rhythm says.
constexpr float kHintRatio = 16.0f;
constexpr double kNearLevel_octaves = 0.12;
constexpr int kSettled_hops = 150;
// What a turn brings to the mean: three seconds of the music, or all there was so far. A level
// changes rarely.
constexpr float kFollowed = 0.03f;
constexpr int kMostHops = 1 << 20;
// Periods within one of so many parts are one level.
constexpr int kSameLevel_parts = 24;
// All periods are judged anew in so many hops.
constexpr std::size_t kTurn_hops = 10;

}  // namespace

TempoEvidence::TempoEvidence(const TempoNet& net, double hop_s, int least_period_hops, int periods)
    : net_(&net),
      hop_s_(hop_s),
      least_period_(least_period_hops),
      judged_(static_cast<std::size_t>(periods), 0.0f),
      hinted_(judged_),
      of_level_(judged_),
      evidence_(judged_) {
  DANCE_ASSERT(periods > 0 && least_period_hops + periods - 1 <= RhythmPeriods::kMostPeriod_hops);
}

void TempoEvidence::set_hint(const TempoHint& hint) {
  const bool is_one =
      hint.tempo_bpm >= kLeastTempo_bpm && hint.tempo_bpm <= kMostTempo_bpm && hint.weight > 0.0;
  hint_ = is_one ? TempoHint{hint.tempo_bpm, std::min(hint.weight, 1.0)} : TempoHint{};
}

// Speaks against half and double of the hinted tempo.
float TempoEvidence::hinted(double period_hops) const {
  if (hint_.weight <= 0.0) return 0.0f;
  const double octaves = std::log2(60.0 / (period_hops * hop_s_) / hint_.tempo_bpm);
  const double away = (std::abs(octaves) - 1.0) / kNearLevel_octaves;
  return -kHintRatio * static_cast<float>(hint_.weight * std::exp(-0.5 * away * away));
}

void TempoEvidence::judge_some() {
  const std::size_t now = (judged_.size() + kTurn_hops - 1) / kTurn_hops;
  const auto turns = static_cast<float>(heard_hops_) / static_cast<float>(kTurn_hops);
  const float follow = std::max(1.0f / (1.0f + turns), kFollowed);
  for (std::size_t k = 0; k < now; ++k, next_ = (next_ + 1) % judged_.size()) {
    const double period_hops = least_period_ + static_cast<double>(next_);
    rhythm_.read(period_hops, values_);
    judged_[next_] += follow * (net_->judge(values_) - judged_[next_]);
    hinted_[next_] = hinted(period_hops);
  }
}

void TempoEvidence::push(const OnsetStrength::Strengths& strengths, float weight) {
  rhythm_.push(strengths);
  judge_some();
  heard_hops_ = std::min(heard_hops_ + 1, kMostHops);
  const float settled =
      std::min(1.0f, static_cast<float>(heard_hops_) / static_cast<float>(kSettled_hops));
  const auto periods = static_cast<int>(judged_.size());
  for (int i = 0; i < periods; ++i) {
    const int reach = (least_period_ + i) / kSameLevel_parts;
    const auto first = judged_.begin() + std::max(0, i - reach);
    const auto end = judged_.begin() + std::min(periods, i + reach + 1);
    const auto at = static_cast<std::size_t>(i);
    of_level_[at] = *std::max_element(first, end) + hinted_[at];
  }
  // A period loses against its half or its double, if one of them is likelier, and against no
  // other: the strokes themselves say better which of other tempi it is, and where the beat lies.
  const auto level_at = [&](int period_hops, float otherwise) {
    const int i = period_hops - least_period_;
    return i >= 0 && i < periods ? of_level_[static_cast<std::size_t>(i)] : otherwise;
  };
  for (int i = 0; i < periods; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int n = least_period_ + i;
    const float own = of_level_[at];
    const float best = std::max({own, level_at((n + 1) / 2, own), level_at(2 * n, own)});
    evidence_[at] = weight * settled * kRhythmEvidence * (own - best);
  }
}

}  // namespace dance
