// HarmonyChange: how much of what sounds now, as tones, did not sound a moment ago. Chords change
// on beats far more often than between them, also where drums and guitars strike on every half of a
// beat.
//
// Units/frames: mono samples at a given rate; change is in no unit. A hop's value belongs to
//               kDelay_s before its end.
// Ownership:    own copies of the last 0.2 s; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      wants finite samples.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace dance {

class HarmonyChange {
 public:
  static constexpr double kDelay_s = 0.164;

  explicit HarmonyChange(double sample_rate_hz);

  float push(std::span<const float> hop);

  // How far each bin stood out of its neighbourhood in the newest hop, and where the bins are.
  std::span<const float> tones() const { return tones_; }
  double tone_hz(std::size_t bin) const { return static_cast<double>(first_bin_ + bin) * bin_hz_; }

 private:
  // Tones are compared over so many hops, which is most of the window: less would compare a window
  // with itself.
  static constexpr std::size_t kLag = 16;

  void find_tones(std::span<float> tones);

  std::size_t thinning_;  // so many samples become one
  float gathered_ = 0.0f;
  std::size_t gathered_count_ = 0;
  std::vector<float> recent_;  // a ring of thinned samples
  std::size_t newest_ = 0;     // where the next goes
  std::vector<float> window_;
  std::vector<float> weighted_;
  std::vector<std::complex<float>> spectrum_;
  Eigen::FFT<float> fft_;
  double bin_hz_;
  std::size_t first_bin_;
  std::size_t bins_;
  std::vector<float> loudness_;
  std::vector<float> tones_;
  std::vector<float> history_;  // kLag rows of bins_ tones
  std::size_t row_ = 0;
  double mean_ = 0.0;  // magnitude of a bin, over some seconds
  std::size_t hops_ = 0;
};

}  // namespace dance
