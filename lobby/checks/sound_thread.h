// SoundThread: the part of a SoundCheck that talks with the sound server, and waits for it.
//
// Units/frames: as sound_check.h.
// Ownership:    owns connection and streams; what it has found is copied into a SoundReport.
// Threads:      all in the one that calls work(), each five milliseconds or so.
// Failure:      a server or a device that is missing is in the report, and looked for again every
//               two seconds.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/sound/pulse_input.h"
#include "core/sound/pulse_output.h"
#include "core/sound/sound_devices.h"
#include "lobby/checks/sound_check.h"

namespace dance {

struct SoundReport {
  SoundState state;
  SoundLevel level;
  bool is_playing = false;
  std::optional<RoundTrip> round_trip;
  std::vector<ListedSound> microphones;
  std::vector<ListedSound> loudspeakers;
};

class SoundThread {
 public:
  explicit SoundThread(const SoundChoice& choice) : choice_(choice) {}

  void choose(const SoundChoice& choice);
  void play_count_in() { play(Playing::kCountIn); }
  void measure_round_trip();
  void work(MonoTime now);
  const SoundReport& report() const { return report_; }

 private:
  enum class Playing { kNothing, kCountIn, kSweep };

  void connect();
  void look_at_devices();
  void list_devices();
  void open_microphone();
  void play(Playing what);
  void fill(MonoTime now);
  float sample_at(std::int64_t frame) const;
  void on_samples(std::span<const float> samples);
  void end_playing();

  SoundChoice choice_;
  SoundReport report_;
  LevelMeter meter_;
  RoundTripMeter trip_;
  std::unique_ptr<PulseServer> server_;
  std::unique_ptr<PulseInput> microphone_;  // after what its samples go to
  std::unique_ptr<PulseOutput> loudspeaker_;
  Playing playing_ = Playing::kNothing;
  MonoTime next_look_;
  std::array<float, 2 * 4800> block_{};
};

}  // namespace dance
