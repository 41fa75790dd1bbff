// HarmonicFit: the part of a motion that comes again with each bar: least squares of sines and
// cosines of the bar's harmonics, of many channels at once, with a memory that fades. One small
// system is solved per frame for all channels.
//
// Units/frames: channels of any unit; positions in bars; weights in seconds.
// Ownership:    fixed arrays; never allocates.
// Threads:      none inside; one owner.
// Failure:      with less than a bar seen the fit is shy: a ridge holds it near zero.
// Source:       leaky recursive least squares; kept as normal equations, which stay positive
//               definite whatever comes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace dance {

class HarmonicFit {
 public:
  static constexpr std::size_t kChannels = 72;
  // Two bars, one, and what lies between and above: steps to alternate sides show at the odd
  // halves.
  static constexpr std::array<double, 5> kHarmonics{0.5, 1.0, 1.5, 2.0, 3.0};
  using Channels = std::array<float, kChannels>;

  HarmonicFit() { forget(); }
  void forget();
  // Takes in what the channels are at a position in bars; dt_s is its weight, memory_s how fast the
  // old fades.
  void add(double bars, double dt_s, double memory_s, const Channels& channels);
  // The periodic part at a position.
  void periodic_at(double bars, Channels& out) const;
  double seen_s() const { return seen_s_; }

 private:
  static constexpr int kTerms = 1 + 2 * static_cast<int>(kHarmonics.size());
  using Terms = Eigen::Matrix<double, kTerms, 1>;

  static Terms terms_at(double bars);

  Eigen::Matrix<double, kTerms, kTerms> gram_;
  // Term by term, all channels of one beside each other.
  std::array<std::array<float, kChannels>, kTerms> moment_;
  double seen_s_ = 0.0;
};

}  // namespace dance
