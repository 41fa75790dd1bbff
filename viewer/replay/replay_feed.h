// ReplayFeed: a recorded house instead of a live one: fills a GuestBoard with the state of any
// moment of a log, in any order. What it shows does not depend on where it was before.
//
// Units/frames: times of the recorded house's clock.
// Ownership:    owns the open log, shares the index; borrows the board.
// Threads:      one owner; a jump unpacks in a few threads that end with the call.
// Failure:      open() names a log that cannot be read. A state of the index that is not sound is
//               left out, and read from the beginning of the log.
#pragma once

#include <memory>
#include <string>

#include "formats/replay/replay_index.h"
#include "formats/replay/replay_log.h"
#include "viewer/feed/guest_board.h"
#include "viewer/replay/board_feed.h"

namespace dance {

class ReplayFeed {
 public:
  static Result<ReplayFeed> open(const std::string& path, std::shared_ptr<const ReplayIndex> index,
                                 GuestBoard& board);
  static ReplayFeed of(ReplayLog log, std::shared_ptr<const ReplayIndex> index, GuestBoard& board);

  const ReplayIndex& index() const { return *index_; }
  // The board as it was at that moment. While a recording is read on, instruments hear all of it.
  void show(MonoTime moment, InstrumentBoard* instruments = nullptr);
  MonoTime shown() const { return shown_; }
  // The same by reading everything from the beginning: what a jump is measured against.
  void show_from_the_beginning(MonoTime moment);
  // Reads everything up to a later moment, however far.
  void read_on_to(MonoTime moment);

 private:
  ReplayFeed(ReplayLog log, std::shared_ptr<const ReplayIndex> index, GuestBoard& board);
  void jump(MonoTime moment);
  bool restore(const ReplayIndex::Checkpoint& checkpoint);
  std::int64_t wall_us(MonoTime moment) const;

  ReplayLog log_;
  std::shared_ptr<const ReplayIndex> index_;
  GuestBoard* board_;
  BoardFeed feed_;
  MonoTime shown_;
  bool has_shown_ = false;
};

}  // namespace dance
