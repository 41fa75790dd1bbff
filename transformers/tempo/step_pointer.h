// StepPointer: a causal Bayesian filter for the position of a dance in the eight counts of its
// steps, beside a music whose tempo is known: the joint probability of each position, each tempo
// close to the music's (or half or double of it), and of no pattern at all. Its memory is what the
// signs of some ten seconds have in common.
//
// Units/frames: counts, eight to the pattern, of what is stepped; tempos in BPM; times of the
//               poses' clock.
// Ownership:    fixed arrays (about 30 kB); never allocates.
// Threads:      none inside; one owner.
// Failure:      sureness() is low while nobody dances, or dances something else; counts() then
//               means nothing.
// Source:       the bar pointer model of beat tracking (Whiteley, Cemgil, Godsill, ISMIR 2006),
//               with motion in place of onsets.
#pragma once

#include <array>
#include <cstddef>

#include "transformers/tempo/step_pattern.h"
#include "transformers/tempo/step_signs.h"

namespace dance {

class StepPointer {
 public:
  explicit StepPointer(const StepPattern& pattern = salsa_steps());

  // Signs of the next slot; the music's tempo, above 0.
  void add(const StepSigns::Slot& slot, double music_bpm);
  void forget();

  // Of the four counts that the dance is most likely in, the probability within two thirds of a
  // count of counts(): 0 nothing is known .. 1.
  float sureness() const { return sureness_; }
  // Steps' position at a moment close to the last slot, in four counts: 0 .. 4 at the last slot.
  double counts(MonoTime t) const;
  double tempo_bpm() const { return tempo_bpm_; }
  // 2: two steps' counts to a beat of the music; 1, 0.5.
  double counts_per_beat() const { return counts_per_beat_; }

 private:
  static constexpr std::size_t kPlaces = 128;  // of eight counts
  static constexpr std::size_t kFold = kPlaces / 2;
  static constexpr std::size_t kTempi = 9;  // a percent apart
  static constexpr std::size_t kRates = 2;  // half and double, where both are danceable
  using Places = std::array<float, kPlaces>;
  struct Row {  // of one tempo; its places are counted from `at`, which goes on at the tempo
    double at = 0.0;
    float start = 0.0f;  // probability before anything is seen
    Places belief{};
  };

  void choose_rates(double music_bpm);
  void move(double music_bpm);
  void change_tempo();
  void judge(const StepSigns::Slot& slot);
  void say();

  std::array<std::array<float, kPlaces>, StepPattern::kSigns> expected_{};
  std::array<float, StepPattern::kSigns> spread_{}, power_{};
  float constant_ = 0.0f;
  std::array<double, kRates> rate_{};
  std::size_t rates_ = 0;
  std::array<Row, kRates * kTempi> rows_{}, moved_{};
  float nothing_ = 1.0f;  // probability of no pattern
  double usual_ = 1.0;    // the dance's tempo against the music's, as it has been so far
  MonoTime middle_;
  double counts_ = 0.0, tempo_bpm_ = 0.0, counts_per_beat_ = 1.0, music_bpm_ = 0.0;
  float sureness_ = 0.0f;
};

}  // namespace dance
