#include "producers/music/tracker/tempo/tempo_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/beat.h"

namespace dance {
namespace {

// How fast a level that is likelier than its half or double gains on it, each hop: in a second,
// once it is clear.
constexpr float kLevelEvidence = 0.06f;
// Of a level: what a network has never heard must not be impossible.
constexpr float kLeastLevel = -6.0f;
// A hint of weight 1 outweighs whatever the rhythm says.
constexpr float kHintRatio = 16.0f;
constexpr double kNearLevel_octaves = 0.12;
constexpr int kSettled_hops = 150;
constexpr int kMostHops = 1 << 20;
// Periods within one of so many parts are one level.
constexpr int kSameLevel_parts = 24;

}  // namespace

TempoEvidence::TempoEvidence(double hop_s, int least_period_hops, int periods)
    : hop_s_(hop_s),
      least_period_(least_period_hops),
      hinted_(static_cast<std::size_t>(periods), 0.0f),
      judged_(hinted_),
      of_level_(hinted_),
      evidence_(hinted_) {
  DANCE_ASSERT(periods > 0 && least_period_hops > 0);
  for (int i = 0; i < periods; ++i)
    place_.push_back(static_cast<float>(
        std::clamp(RhythmNet::place_of_tempo(60.0 / ((least_period_hops + i) * hop_s)), 0.0,
                   RhythmNet::kTempi - 1.001)));
}

void TempoEvidence::set_hint(const TempoHint& hint) {
  const bool is_one =
      hint.tempo_bpm >= kLeastTempo_bpm && hint.tempo_bpm <= kMostTempo_bpm && hint.weight > 0.0;
  const TempoHint now =
      is_one ? TempoHint{hint.tempo_bpm, std::min(hint.weight, 1.0)} : TempoHint{};
  if (now.tempo_bpm == hint_.tempo_bpm && now.weight == hint_.weight) return;
  hint_ = now;
  for (std::size_t i = 0; i < hinted_.size(); ++i)
    hinted_[i] = hinted(least_period_ + static_cast<double>(i));
}

// Speaks against half and double of the hinted tempo.
float TempoEvidence::hinted(double period_hops) const {
  if (hint_.weight <= 0.0) return 0.0f;
  const double octaves = std::log2(60.0 / (period_hops * hop_s_) / hint_.tempo_bpm);
  const double away = (std::abs(octaves) - 1.0) / kNearLevel_octaves;
  return -kHintRatio * static_cast<float>(hint_.weight * std::exp(-0.5 * away * away));
}

void TempoEvidence::push(const Eigen::VectorXf& tempi, float weight) {
  heard_hops_ = std::min(heard_hops_ + 1, kMostHops);
  const float settled =
      std::min(1.0f, static_cast<float>(heard_hops_) / static_cast<float>(kSettled_hops));
  const auto periods = static_cast<int>(judged_.size());
  for (std::size_t i = 0; i < judged_.size(); ++i) {
    const auto below = static_cast<Eigen::Index>(place_[i]);
    const float share = place_[i] - static_cast<float>(below);
    judged_[i] = std::max(kLeastLevel, (1.0f - share) * tempi[below] + share * tempi[below + 1]);
  }
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
    evidence_[at] = weight * settled * kLevelEvidence * (own - best);
  }
}

}  // namespace dance
