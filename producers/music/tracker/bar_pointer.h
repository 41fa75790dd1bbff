// BarPointer: a causal Bayesian filter for tempo and position in the bar: the joint probability of
// each tempo, each position in a bar and each rhythm pattern, updated every hop by onset strengths
// and the likelihoods of strokes.
//
// Units/frames: time in hops of onset strengths; periods are hops a beat.
// Ownership:    owns its tables, about 3 MB; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      wants strengths that are finite. Where nothing is heard (weight 0) it moves on and
//               the distribution slowly widens.
// Source:       the state space and its changes of tempo at beats follow Krebs, Böck and Widmer,
//               "An efficient state-space model for joint tempo and meter tracking", ISMIR 2015;
//               here with exponential laws of strengths, filtered.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "producers/music/tracker/meter_pattern.h"
#include "producers/music/tracker/net/rhythm_net.h"
#include "producers/music/tracker/onset_strength.h"

namespace dance {

class BarPointer {
 public:
  static constexpr float kMostStrength = 15.0f;
  // How long a stroke stays visible, and how much later low and tonal groups show it than high ones
  // do.
  static constexpr std::array<double, kOnsetGroups> kBlur_s{0.012, 0.012, 0.012, 0.012, 0.035};
  static constexpr std::array<double, kOnsetGroups> kLater_s{0.014, 0.006, 0.004, 0.0, 0.15};

  struct Place {
    double period_hops = 0.0;
    double to_beat_hops = 0.0;  // from the newest strengths to the next beat
    double probability = 0.0;
  };

  // At least one pattern; they are not needed afterwards.
  BarPointer(double hop_s, std::span<const MeterPattern> patterns);

  // The shortest and the longest beat that are searched.
  int least_period_hops() const { return period_hops_.front(); }
  int most_period_hops() const { return period_hops_.back(); }

  // Strengths of the next hop, and what the stroke of some hops ago was. weight: their weight, 0
  // (there is no music) to 1. of_periods: what else speaks for or against a beat of each number of
  // hops, from the shortest to the longest, as a logarithm of likelihood.
  void push(const OnsetStrength::Strengths& strengths, const StrokeMeaning& meaning, float weight,
            std::span<const float> of_periods);

  Place likeliest() const;
  // The mean of what is close to a place: another tempo by a few percent, another phase by less
  // than a sixth of a beat.
  Place near(double period_hops, double to_beat_hops) const;

 private:
  // The places of a bar at one tempo under one pattern.
  struct Block {
    std::size_t pattern;
    int tempo;    // index
    int first;    // of its states
    float start;  // probability of each before anything is heard
  };

  int period(int tempo) const { return period_hops_[static_cast<std::size_t>(tempo)]; }
  void choose_tempi();
  double start_weight(int tempo) const;
  void make_states(std::span<const MeterPattern> patterns);
  void describe(const MeterPattern& pattern, const Block& block);
  void make_places();
  void make_tempo_changes();
  void gather_beat_ends();

  double hop_s_;
  std::vector<int> period_hops_;  // of each tempo
  int tempi_ = 0;
  std::size_t patterns_;
  std::vector<Block> blocks_;
  Eigen::ArrayXf state_;
  // Logarithm of a strength's law in a state: constant_ - sum of slopes * strengths.
  Eigen::ArrayXf constant_;
  std::array<Eigen::ArrayXf, kOnsetGroups> slope_;
  // By tempo and place in a bar: how close the stroke that is judged was to a beat, or to a half.
  std::vector<int> bar_first_;
  Eigen::ArrayXf on_beat_;
  Eigen::ArrayXf on_half_;
  Eigen::ArrayXf meant_;
  Eigen::MatrixXf tempo_change_;  // to, from
  // Column: pattern and beat of the bar; row: tempo.
  Eigen::MatrixXf ending_;
  Eigen::MatrixXf entering_;
  Eigen::VectorXf total_;
  // Over all patterns and beats of the bar: probability of each tempo (block) and place in the
  // beat.
  std::vector<int> beat_first_;
  Eigen::ArrayXf beat_;
};

}  // namespace dance
