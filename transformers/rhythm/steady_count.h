// SteadyCount: the even count behind words that wander: dancers go about the beat by a tenth of a
// second within a figure, the music they dance to goes on evenly. A Kalman filter for place and
// tempo; its first words count most, later ones ever less, down to a memory of some ten seconds.
//
// Units/frames: counts; counts a second; seconds between words.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

namespace dance {

class SteadyCount {
 public:
  double counts() const { return counts_; }
  double counts_per_s() const { return counts_per_s_; }

  void begin(double counts, double counts_per_s) {
    counts_ = counts;
    counts_per_s_ = counts_per_s;
    place_ = kWord / kWordsAlike;
    both_ = 0.0;
    const double tempo = kTempo * counts_per_s;
    tempo_ = tempo * tempo;
  }

  void go_on(double s) {
    counts_ += counts_per_s_ * s;
    place_ += s * (2.0 * both_ + s * tempo_ + kPlaceWanders);
    both_ += s * tempo_;
    tempo_ += s * kTempoWanders;
  }

  // By how much a word is ahead of the count.
  void hear(double ahead) {
    const double scale = 1.0 / (place_ + kWord);
    counts_ += place_ * scale * ahead;
    counts_per_s_ += both_ * scale * ahead;
    tempo_ -= both_ * both_ * scale;
    both_ *= kWord * scale;
    place_ *= kWord * scale;
  }

 private:
  // Of a word: a tenth of a count off, and for some seconds alike. The first tempo is known to
  // about a percent.
  static constexpr double kWordsAlike = 30.0;
  static constexpr double kWord = 0.11 * 0.11 * kWordsAlike;
  static constexpr double kTempo = 0.015;
  // Variances a second.
  static constexpr double kPlaceWanders = 1e-3, kTempoWanders = 1e-5;

  double counts_ = 0.0, counts_per_s_ = 0.0;
  double place_ = 0.0, both_ = 0.0, tempo_ = 0.0;  // covariances
};

}  // namespace dance
