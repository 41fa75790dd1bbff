// LineMeter: what one direction of a line makes of a dance: which poses come and how old, and what
// a stage with the default play-out (hold) shows of them. Pure: the caller tells it what
// happened.
//
// Units/frames: one clock for all times; poses carry their capture as the link mapped it, the meter
//               knows when it really was.
// Ownership:    keeps each pose's age; allocates in its constructor only, for as many poses as
//               said.
// Threads:      none inside; one owner.
// Failure:      what goes beyond that many is not counted.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "transformers/flow.h"

namespace dance {

// A stage that shows nothing new for so long visibly stands still.
constexpr Duration kFreeze = Duration::ms(100);

struct LineFigures {
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  bool has_first = false;
  Duration first;                    // from the beginning to the first pose
  std::vector<Duration> ages;        // capture to handler, of those delivered; sorted
  std::vector<Duration> stage_ages;  // of what a stage shows, moment by moment; sorted
  std::uint64_t freezes = 0;         // times of at least kFreeze without a new pose on the stage
  Duration frozen;                   // all of them together
  Duration worst_gap;                // between two poses delivered
  bool worst_gap_is_over = true;     // false: no pose came any more
  Duration worst_gap_to_pose;     // from when the line could have delivered again to the first pose
  Duration worst_gap_round_trip;  // of the line, when that pose came
  Duration slowest_after_gap;     // the same of any gap of at least kFreeze
  std::uint64_t older_delivered = 0;  // after a newer one
  std::uint64_t older_shown = 0;      // moments that went back
};

class LineMeter {
 public:
  // Sequences are 1 to `most_poses`.
  LineMeter(MonoTime begin, std::size_t most_poses);

  void sent(std::uint32_t sequence, MonoTime captured);
  // Whether the line carries just now, and what it takes.
  void look(std::optional<Duration> took, MonoTime now);
  Duration last_took() const { return last_took_; }
  // `back`: what the other direction takes just now.
  void delivered(const Pose& pose, Duration back, MonoTime now);
  // The stage shows its next moment.
  void show(MonoTime now);
  // Nothing is sent or shown any more; what is still under way may be delivered.
  void end_dance(MonoTime now);

  LineFigures figures() const;

 private:
  struct Known {
    MonoTime mapped, captured;
  };
  static constexpr std::size_t kKnown = 512;

  void note_gap(Duration back, MonoTime now);
  // When the moment was that the stage shows as `mapped`.
  MonoTime captured_at(MonoTime mapped) const;
  void note_stillness(MonoTime now);

  MonoTime begin_;
  std::vector<MonoTime> captured_;  // by sequence
  LineFigures figures_;
  std::uint32_t newest_ = 0;
  MonoTime last_delivered_;
  Duration last_took_;
  bool is_cut_ = false;
  MonoTime back_at_;  // after a cut since the last pose: when the line could have delivered again
  Flow stage_;
  std::array<Known, kKnown> known_{};  // what the stage has, a ring
  std::size_t known_count_ = 0;
  MonoTime shown_;        // the moment on the stage,
  MonoTime shown_since_;  // and since when it stands there
};

}  // namespace dance
