// OnsetStrength: how much begins to sound, a hundred times a second: the rise of the logarithmic
// spectrum, summed in a few groups of bands, each in units of its own recent mean. A beat tracker's
// input.
//
// Units/frames: mono samples of any scale at a given rate; a hop is 10 ms. Strengths are 1 on
//               average. A hop's strengths belong to kDelay_s
//               before its end.
// Ownership:    own copies of the last 46 ms; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      samples that are not finite count as silence; silence has strength 0.
// Source:       the spectral flux with a maximum filter over neighbouring bands follows Böck and
//               Widmer, "Maximum filter vibrato suppression for onset detection", DAFx 2013.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "producers/music/tracker/harmony_change.h"

namespace dance {

// Four ranges of pitch, and the change of harmony.
constexpr std::size_t kOnsetGroups = 5;

class OnsetStrength {
 public:
  using Strengths = std::array<float, kOnsetGroups>;

  static constexpr double kHops_hz = 100.0;
  // Means over songs whose beats are known: docs/music-tracking.md. A bare click shows some 6 ms
  // sooner.
  static constexpr double kDelay_s = 0.022;
  static constexpr double kLeastRate_hz = 8000.0;
  static constexpr double kMostRate_hz = 200000.0;

  explicit OnsetStrength(double sample_rate_hz);

  std::size_t hop_samples() const { return hop_; }
  double sample_rate_hz() const { return sample_rate_hz_; }
  // Exactly hop_samples() samples, which follow those of the last call.
  Strengths push(std::span<const float> hop);

  // What the newest hop's strengths are made of.
  std::span<const std::complex<float>> spectrum() const { return spectrum_; }
  double bin_hz() const { return sample_rate_hz_ / window_samples_; }
  const HarmonyChange& harmony() const { return harmony_; }

 private:
  static constexpr std::size_t kMostBands = 48;
  // A rise is one over so many hops: the window is longer than a hop.
  static constexpr std::size_t kLag = 2;
  struct Band {
    int first_bin = 0;
    int end_bin = 0;
    std::size_t group = 0;
  };

  void make_bands();
  void compress(std::span<float> loudness);

  double sample_rate_hz_;
  std::size_t hop_;
  int window_samples_;
  std::vector<float> window_;
  std::vector<float> recent_;  // the last window_samples_ samples, oldest first
  std::vector<float> weighted_;
  std::vector<std::complex<float>> spectrum_;
  Eigen::FFT<float> fft_;
  HarmonyChange harmony_;
  std::vector<Band> bands_;
  std::array<float, kMostBands> level_{};  // slow mean of each band's magnitude
  std::array<std::array<float, kMostBands>, kLag>
      before_{};  // loudness of the last hops, newest first
  std::array<double, kOnsetGroups> mean_{};
  std::size_t hops_ = 0;
};

}  // namespace dance
