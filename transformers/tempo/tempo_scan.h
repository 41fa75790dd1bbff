// TempoScan: the tempo of a dance from its motion alone: of all tempos that people dance to, the
// one whose bars explain most of it. A bar shows in places (steps to the left and to the right come
// again after two bars, after one, and in between) and in the feet's speed (each step, and where in
// the bar there is none); one harmonic alone is as strong at half the tempo and at twice.
//
// Units/frames: samples at a steady 30 Hz, without their mean; tempos in beats a minute, four beats
//               to a bar.
// Ownership:    fixed arrays (about 80 kB); never allocates.
// Threads:      none inside; one owner.
// Failure:      score() is low while there is no tempo.
// Source:       a bank of complex demodulators, each two poles; the prior on tempo is log-normal,
//               as beat trackers'.
#pragma once

#include <array>
#include <cstddef>

namespace dance {

// What people dance to: most of it between 90 and 230, and half of what steps on each beat is as
// periodic.
constexpr double kUsual_bpm = 155.0, kUsualWidth_octaves = 0.6;

class TempoScan {
 public:
  static constexpr std::size_t kPlaces = 19;
  static constexpr std::size_t kChannels = kPlaces + 1;  // the last one is the feet's speed
  using Sample = std::array<float, kChannels>;

  TempoScan();
  void add(const Sample& sample);
  // 0 before there is any.
  double tempo_bpm() const { return tempo_bpm_; }
  // Part of the motion that the tempo's bars explain, 0 to about 1.
  float score() const { return score_; }
  // The same of the tempo that is nearest to this one.
  float score_at(double bpm) const;
  void forget();

 private:
  // A forty-eighth of an octave: halves and doubles are bins too, and three quarters nearly.
  static constexpr int kBinsPerOctave = 48;
  static constexpr std::size_t kBins = 235;
  static constexpr std::size_t kParts =
      3;  // a third of the bins per sample, each with three samples' mean

  struct Bin {
    float step_re = 1.0f, step_im = 0.0f;  // turn per scan
    float re = 1.0f, im = 0.0f;
    std::array<float, kChannels> first_re{}, first_im{}, second_re{}, second_im{};
  };

  void turn(std::size_t begin, std::size_t end);
  void choose();
  float score_of(std::size_t beat_bin) const;

  std::array<Bin, kBins> bins_;
  std::array<float, kBins> power_places_{}, power_steps_{};
  Sample sum_{}, scanned_{};
  std::array<float, 2> energy_places_{}, energy_steps_{};
  std::size_t part_ = 0;
  double tempo_bpm_ = 0.0;
  float score_ = 0.0f;
  int scans_ = 0;
};

}  // namespace dance
