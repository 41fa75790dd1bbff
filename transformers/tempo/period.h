// Period: where in its step a dance is, from its motion alone or beside the music: tempo, position
// in the bar, how sure that is for each zone of the body, and the moments that people see on the
// beat. A part of stations, no station itself.
//
// Motion tells the phase only roughly (a dancer's own figures wander by a tenth of a second): use
// it as a slow correction, gated by coherence(); the clock is the music where there is any.
//
// Units/frames: beats, four to a bar, of what the dancer steps; times of the poses' clock. Poses
//               that carry musical time bring the tempo and the bar with them; without it both are
//               found, and counted from somewhere.
// Ownership:    fixed arrays (about 100 kB); never allocates. 3.5 us a pose at 60 Hz.
// Threads:      none inside; one owner.
// Failure:      is_known() is false until about 5 s of a dance have been seen, and again after a
//               jump of the poses' time.
// Source:       lock-in detection against a slowly learnt complex template, at the harmonics of two
//               bars together.
#pragma once

#include <array>
#include <complex>

#include "transformers/tempo/motion_beats.h"
#include "transformers/tempo/motion_channels.h"
#include "transformers/tempo/tempo_scan.h"

namespace dance {

class Period {
 public:
  static constexpr double kBeatsPerBar = 4.0;

  void set_body(const Skeleton& skeleton) { channels_.set_body(skeleton); }
  // Poses in the order of their capture; what is not newer is passed over.
  void observe(const Pose& pose, MonoTime now);
  // The tempo of the music, where poses do not carry it; 0: find it.
  void set_tempo(double tempo_bpm) { told_bpm_ = tempo_bpm; }
  void forget();

  bool is_known() const { return known_ticks_ > kTicksBeforeWord; }
  // Of the steps as they are danced.
  double tempo_bpm() const;
  // True where the poses carry musical time: beats() then counts as the music does.
  bool has_music() const { return has_music_; }
  // Position in the steps at a moment, ahead of the last pose or behind it. Continuous; which beat
  // is called 0 is arbitrary where there is no music.
  double beats(MonoTime capture) const;
  // By how much the dance stands ahead of its own usual place in the music, in beats; 0 without
  // music.
  double ahead_beats() const { return has_music_ ? kBeatsPerBar * phase_ : 0.0; }
  // The same at a place of the bar that the steps themselves tell: whole numbers where feet come to
  // stand, 3 where they rest. In 0 .. 4; no better than is_anchored() says.
  double count(MonoTime capture) const;
  bool is_anchored() const { return anchored_; }
  // How well the last bar fits what was learnt of this dancer: 0 none .. 1 the same; trust phases
  // above 0.6.
  float coherence() const { return coherence_; }

  // Part of the motion that bars of this tempo explain.
  float score_at(double bpm) const { return scan_.score_at(bpm); }

  const MotionBeats& motion_beats() const { return motion_beats_; }
  MonoTime newest() const { return frame_.time; }
  // What the newest pose shows.
  const MotionFrame& frame() const { return frame_; }

 private:
  // Of the bar: two bars, one, and between.
  static constexpr std::size_t kHarmonics = 4;
  static constexpr std::array<double, kHarmonics> kHarmonic{0.5, 1.0, 1.5, 2.0};
  static constexpr int kTicksBeforeWord = 90;
  using Complex = std::complex<float>;
  using Channels = std::array<Complex, kMotionChannels>;

  void restart(const MotionFrame& frame);
  void tick(const MotionFrame& frame);
  void choose_tempo();
  void lock_in();
  void follow(const std::array<std::array<Complex, kMotionGroups>, kHarmonics>& match);
  void learn();
  void anchor(std::size_t new_beats);

  MotionChannels channels_;
  MotionBeats motion_beats_;
  TempoScan scan_;
  MotionFrame frame_, tick_frame_;  // of the newest pose, and of the newest tick
  MonoTime next_tick_;
  std::uint64_t clock_id_ = 0;
  bool has_frame_ = false, has_music_ = false, anchored_ = false;
  double told_bpm_ = 0.0;

  std::array<float, kMotionChannels> mean_{}, moved_{};
  std::array<float, kMotionGroups> variance_{}, template_power_{}, match_power_{};
  double bars_ = 0.0;        // position of the reference, in bars
  double bars_per_s_ = 0.0;  // 0: not known yet
  double phase_ = 0.0;       // of the dance against the reference, in bars
  double slip_ = 0.0;        // of the phase, bars a second
  std::array<Channels, kHarmonics> lock_{}, template_{};
  int known_ticks_ = 0, ticks_ = 0;
  float coherence_ = 0.0f;
  std::complex<double> beat_anchor_;
  std::array<double, 4> step_at_{};
  int rest_ = 0;
};

}  // namespace dance
