// PulsePlayer: plays music through the sound server, heard when it should be: latency counted in,
// drift corrected.
//
// Units/frames: `trim` is latency that the server does not know of (an amplifier, a television).
// Ownership:    owns the source and its connection with the server.
// Threads:      none inside.
// Failure:      open() names what is missing; work() fails where the music is damaged or the
//               connection is lost.
#pragma once

#include <memory>
#include <vector>

#include "core/base/histogram.h"
#include "core/sound/pulse_output.h"
#include "producers/music/music_player.h"
#include "producers/music/music_source.h"
#include "producers/music/sound/play_plan.h"
#include "producers/music/sound/volume_ramp.h"

namespace dance {

struct PulsePlayerOptions {
  double volume = 1.0;
  Duration trim;
};

class PulsePlayer : public MusicPlayer {
 public:
  static Result<std::unique_ptr<PulsePlayer>> open(std::unique_ptr<MusicSource> source,
                                                   const PulsePlayerOptions& options);

  void play_from(MonoTime begin, bool loops) override {
    // Another place in the music is reached at once, not at the next correction.
    if (!begin_ || PlayPlan::wants_jump((begin - *begin_).as_seconds()))
      next_correction_ = MonoTime();
    begin_ = begin;
    source_->set_loops(loops);
  }
  void pause() override { begin_.reset(); }
  // Within some milliseconds, without a click.
  void set_volume(double volume) override { gain_.set(volume); }
  void set_speed(double speed) override { source_->set_speed(speed); }
  std::optional<double> heard_s(MonoTime t) const override;
  Result<void> work(MonoTime now) override;
  std::string summary() const override;

 private:
  PulsePlayer(std::unique_ptr<MusicSource> source, const PulsePlayerOptions& options);
  void keep_in_step(MonoTime now);
  Result<void> fill();

  std::unique_ptr<MusicSource> source_;
  PulsePlayerOptions options_;
  std::unique_ptr<PulseServer> server_;
  StreamClock clock_;
  PlayPlan plan_;
  std::unique_ptr<PulseOutput> output_;  // last: its reports go to what stands above
  std::optional<MonoTime> begin_;
  MonoTime next_timing_request_;
  MonoTime next_correction_;
  std::vector<float> block_;
  VolumeRamp gain_;
  Histogram errors_;
  std::uint64_t jumps_ = 0;
};

}  // namespace dance
