// TempoEvidence: which tempo dancers step at, by the rhythm of the last seconds and by what is
// known from elsewhere: the dancers themselves, or a person who says it.
//
// Units/frames: periods in hops of onset strengths; evidence is a logarithm of likelihood a hop.
// Ownership:    fixed arrays of its own; never allocates after construction. Refers to the network,
//               which must outlive it.
// Threads:      none inside; one owner.
// Failure:      a hint that is no tempo, or has no weight, is none.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "producers/music/tracker/tempo/rhythm_periods.h"
#include "producers/music/tracker/tempo/tempo_net.h"

namespace dance {

// The tempo of steps that are seen. It chooses between a tempo, its half and its double, and says
// nothing about a tempo beside these.
struct TempoHint {
  double tempo_bpm = 0.0;
  double weight = 0.0;  // 0 = none … 1 = surely the dancers' steps
};

class TempoEvidence {
 public:
  // For beats of so many hops and each one longer.
  TempoEvidence(const TempoNet& net, double hop_s, int least_period_hops, int periods);

  void set_hint(const TempoHint& hint);
  // The next hop. weight as BarPointer::push.
  void push(const OnsetStrength::Strengths& strengths, float weight);
  // Of each period.
  std::span<const float> of_periods() const { return evidence_; }

 private:
  float hinted(double period_hops) const;
  void judge_some();

  const TempoNet* net_;
  double hop_s_;
  int least_period_;
  TempoHint hint_;
  RhythmPeriods rhythm_;
  std::array<float, RhythmPeriods::kCount> values_{};
  std::vector<float> judged_, hinted_, of_level_, evidence_;  // of each period
  std::size_t next_ = 0;
  int heard_hops_ = 0;
};

}  // namespace dance
