// Flows with one slot filled by hand, for tests of what fills it.
//
// Units/frames: as transformers/flow.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <optional>

#include "transformers/flow.h"
#include "transformers/playout/hold_clock.h"
#include "transformers/playout/live_clock.h"
#include "transformers/predict/dance_extrapolator.h"
#include "transformers/rhythm/rhythm_clock.h"

namespace dance {

inline MonoTime at_ms(double ms) { return MonoTime::from_ns(static_cast<std::int64_t>(ms * 1e6)); }

// The play-out buffer alone.
class Hold : public Flow {
 public:
  explicit Hold(std::optional<Duration> window = std::nullopt) : Flow(slots(window)) {}
  Duration delay() const { return static_cast<const HoldClock*>(clock())->delay(); }

 private:
  static Slots slots(std::optional<Duration> window) {
    Slots slots;
    slots.clock = std::make_unique<HoldClock>(window);
    slots.source.is_final = true;
    slots.poses = 256;
    return slots;
  }
};

// The rhythm clock over what came, with another clock beneath it or none.
class Rhythm : public Flow {
 public:
  explicit Rhythm(const RhythmOptions& options = {},
                  std::unique_ptr<PlayoutClock> free_running = nullptr)
      : Flow(slots(options, std::move(free_running))) {}
  bool is_in_time() const { return rhythm().is_in_time(); }
  double offset_beats() const { return rhythm().offset_beats(); }

 private:
  const RhythmClock& rhythm() const { return *static_cast<const RhythmClock*>(clock()); }
  static Slots slots(const RhythmOptions& options, std::unique_ptr<PlayoutClock> free_running) {
    Slots slots;
    slots.clock = std::make_unique<RhythmClock>(options, std::move(free_running));
    slots.poses = 512;
    slots.has_finish = true;
    slots.corrects_from_now = true;
    return slots;
  }
};

// A live dancer behind a given extrapolator, whose lapses are concealed.
inline Flow concealed(std::unique_ptr<Extrapolator> extrapolator) {
  Flow::Slots slots;
  slots.clock = std::make_unique<LiveClock>();
  slots.source.extrapolator = std::move(extrapolator);
  slots.source.concealment = std::make_unique<Concealment>();
  slots.poses = Concealment::kPoses;
  slots.has_finish = true;
  return Flow(std::move(slots));
}

}  // namespace dance
