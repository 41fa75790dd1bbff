// BeatMeter: how well one dancer on this stage is in time with the music of this house: mean offset
// behind the beat, its spread, the delay from capture to display, and where the dancer's own beats
// fell.
//
// Units/frames: positions in beats of this house's music; ms, positive is behind the beat.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      figures() is nullopt before eight poses with musical time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/time.h"

namespace dance {

struct BeatFigures {
  float behind_ms = 0.0f;         // the nearest beat; circular mean of the last seconds
  float wander_ms = 0.0f;         // its standard deviation
  std::optional<float> delay_ms;  // negative: predicted ahead of now
  // Where the music of this house stood when the dancer's own beats were shown, oldest first.
  static constexpr std::size_t kOwnBeats = 16;
  std::array<double, kOwnBeats> own_beats{};
  std::size_t own_beat_count = 0;
};

class BeatMeter {
 public:
  // A pose that was danced at `own` beats is shown when this house's music stands at `heard`. The
  // delay is from capture, of poses of a clock that can be compared.
  void add(double own, double heard, double beats_per_second, std::optional<Duration> delay);
  std::optional<BeatFigures> figures() const;

  // So many poses back figures() looks.
  static constexpr std::size_t kSamples = 240;  // 4 s at 60 Hz
  std::size_t count() const { return count_; }
  // As BeatClock::carry(); the samples may be left out where kSamples others will follow.
  template <class Archive>
  void carry(Archive& archive, bool has_samples) {
    archive(count_), archive(own_beat_count_), archive(beats_per_second_);
    archive(last_own_), archive(last_heard_);
    for (double& beat : own_beats_) archive(beat);
    if (!has_samples) return;
    for (Sample& sample : samples_)
      archive(sample.cosine), archive(sample.sine), archive(sample.delay_ms);
  }

 private:
  static constexpr std::size_t kFewest = 8;
  struct Sample {
    float cosine = 1.0f, sine = 0.0f;  // of the part of a beat behind, as an angle
    std::optional<float> delay_ms;
  };
  void note_own_beats(double own, double heard);

  std::array<Sample, kSamples> samples_{};
  std::size_t count_ = 0;
  std::array<double, BeatFigures::kOwnBeats> own_beats_{};
  std::size_t own_beat_count_ = 0;
  double beats_per_second_ = 1.0;
  double last_own_ = 0.0, last_heard_ = 0.0;
};

}  // namespace dance
