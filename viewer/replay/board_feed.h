// BoardFeed: what a log tells, told to a GuestBoard in the recorded house's own time.
//
// Units/frames: as viewer/feed/guest_board.h.
// Ownership:    borrows board and instruments.
// Threads:      none inside; one owner.
// Failure:      messages that do not decode are left out.
#pragma once

#include "formats/replay/replay_log.h"
#include "viewer/feed/guest_board.h"
#include "viewer/instruments/instrument_board.h"

namespace dance {

class BoardFeed : public ReplaySink {
 public:
  BoardFeed(GuestBoard& board, std::int64_t wall_ahead_us)
      : board_(board), wall_ahead_us_(wall_ahead_us) {}

  void on_message(const Channel& channel, std::span<const std::uint8_t> message,
                  std::int64_t time_us, bool is_passed) override;
  void on_glance(const Channel& channel, const Pose* pose, std::int64_t time_us) override;

  // These hear every message too; nullptr: none do.
  void set_instruments(InstrumentBoard* instruments) { instruments_ = instruments; }

  MonoTime time_of(std::int64_t time_us) const {
    return MonoTime::from_us(time_us - wall_ahead_us_);
  }

 private:
  GuestBoard& board_;
  InstrumentBoard* instruments_ = nullptr;
  std::int64_t wall_ahead_us_;
};

}  // namespace dance
