// TempoEvidence: which tempo dancers step at, by what a network hears and by what is known from
// elsewhere: the dancers themselves, or a person who says it.
//
// Units/frames: periods in hops of onset strengths; evidence is a logarithm of likelihood a hop.
// Ownership:    fixed arrays of its own; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a hint that is no tempo, or has no weight, is none.
#pragma once

#include <span>
#include <vector>

#include "producers/music/tracker/net/rhythm_net.h"

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
  TempoEvidence(double hop_s, int least_period_hops, int periods);

  void set_hint(const TempoHint& hint);
  // The next hop. tempi: logarithms of the probability of each of RhythmNet::kTempi; weight as
  // BarPointer::push.
  void push(const Eigen::VectorXf& tempi, float weight);
  // Of each period.
  std::span<const float> of_periods() const { return evidence_; }

 private:
  float hinted(double period_hops) const;

  double hop_s_;
  int least_period_;
  TempoHint hint_;
  std::vector<float> place_;  // of each period, among the network's tempi
  std::vector<float> hinted_, judged_, of_level_, evidence_;  // of each period
  int heard_hops_ = 0;
};

}  // namespace dance
