// GuestMeter: measures one guest of a house, from the poses that pass on its bus: where the time
// goes from capture to display, how evenly poses arrive, how far ahead of them the stage is and how
// right that was, and where the dance is on the beat.
//
// Units/frames: times of the house's clock; only poses of that clock are timed. Figures as
//               lcmtypes/guest_stats_t.lcm says.
// Ownership:    plain value of some 60 kB; never allocates.
// Threads:      none inside; one owner.
// Failure:      time that goes back (a recording that is sought in), and a sequence that jumps far,
//               is a new beginning.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/beat_clock.h"
#include "core/bus/messages.h"
#include "core/pose/pose.h"
#include "core/signal/flow_setting.h"
#include "viewer/instruments/prediction_check.h"
#include "viewer/instruments/sample_window.h"
#include "viewer/scene/beat_meter.h"

namespace dance {

class GuestMeter {
 public:
  explicit GuestMeter(std::uint64_t clock_id = 0) : clock_id_(clock_id) {}

  // Came through the tunnel, or was captured in this house.
  void on_arrived(const Pose& pose, MonoTime heard, const BeatClock& music);
  void on_staged(const Pose& pose, MonoTime heard, const BeatClock& music);
  // A display showed it.
  void on_shown(const StageTime& shown);
  void on_traffic(const GuestTraffic& traffic);
  // A route without transformers stages what comes; its poses may be heard before the captures.
  void on_flow(const FlowSetting& setting);
  void set_body(const Skeleton& skeleton) { predictions_.set_body(skeleton); }

  bool is_due(MonoTime now) const;
  // The figures of the second that ends, and the beginning of the next.
  GuestStats end_second(MonoTime now);

 private:
  static constexpr std::size_t kSamples = 256;
  static constexpr std::size_t kStagedKept = 32;
  using Samples = SampleWindow<kSamples>;
  // What had arrived when the stage made a pose.
  struct Arrival {
    std::uint32_t sequence = 0;  // of the stage's pose, in the ring
    MonoTime capture;
    std::array<MonoTime, kHopCount> hops{};
  };

  void begin_at(MonoTime now);
  void count(std::uint32_t sequence);
  void add_gaps(MonoTime capture, const std::array<MonoTime, kHopCount>& hops, MonoTime heard);
  void hear_beat(const Pose& pose, MonoTime heard, const BeatClock& music);
  bool shows_stage(MonoTime now) const;
  void tell_traffic(GuestStats& stats, MonoTime now) const;

  std::uint64_t clock_id_;
  MonoTime begin_;
  std::array<Samples, kGapCount> gaps_ms_;
  Samples newest_ms_, age_ms_, horizon_ms_;
  PredictionCheck predictions_;
  BeatMeter beats_;
  double beats_per_second_ = 0.0;
  bool has_beats_ = false;

  Arrival newest_;
  bool is_pass_through_ = false;
  bool has_arrived_ = false, has_staged_ = false, has_shown_ = false, is_shown_staged_ = false;
  std::array<Arrival, kStagedKept> staged_;
  std::size_t staged_count_ = 0;
  MonoTime last_staged_, last_shown_;
  std::uint32_t arrived_sequence_ = 0, shown_sequence_ = 0;
  Duration transit_;
  double jitter_ms_ = 0.0;
  std::int64_t arrived_now_ = 0, lost_now_ = 0, staged_now_ = 0, shown_now_ = 0;
  std::int64_t received_ = 0, lost_ = 0, late_ = 0, superseded_ = 0;
  GuestTraffic traffic_, traffic_before_;
};

}  // namespace dance
