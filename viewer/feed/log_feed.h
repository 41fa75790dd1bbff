// LogFeed: a recorded house instead of a live one: fills a GuestBoard from an LCM log up to any
// moment, at any pace, repeatedly.
//
// Units/frames: times of the recorded house's clock, which goes on when the log repeats; the log's
//               wall clock is mapped onto it by the poses with the least delay to the log.
// Ownership:    owns the log and the board.
// Threads:      none inside; one owner.
// Failure:      open() names a log that cannot be read, or without poses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/log/unpacked_log.h"
#include "viewer/feed/guest_board.h"
#include "viewer/instruments/instrument_board.h"

namespace dance {

class LogFeed {
 public:
  static Result<LogFeed> open(const std::string& path, bool stage_only);

  GuestBoard& board() { return *board_; }
  InstrumentBoard& instruments() { return *instruments_; }
  MonoTime begin() const { return begin_; }
  MonoTime end() const { return end_ + shift_; }
  // When the house's music was at that beat; nullopt where it never was.
  std::optional<MonoTime> time_of_beat(double beat) const;
  // Reads the log up to that moment; moments only advance.
  void go_on_to(MonoTime now);
  // Repeats the log after its end.
  void begin_again();

 private:
  LogFeed(std::string path, UnpackedLog log) : path_(std::move(path)), log_(std::move(log)) {}
  Result<void> look_through();
  Result<bool> find_times(Where where, Hop last);
  void take(const LogEvent& event, MonoTime now);
  MonoTime time_of(const LogEvent& event) const;

  struct WholeBeat {
    double beat;
    MonoTime time;
  };
  std::string path_;
  UnpackedLog log_;
  std::unique_ptr<GuestBoard> board_;
  std::unique_ptr<InstrumentBoard> instruments_;
  std::optional<LogEvent> next_;
  std::uint64_t clock_id_ = 0;
  std::int64_t wall_ahead_us_ = 0;  // of the house's clock
  MonoTime begin_, end_;
  Duration shift_;  // of what is taken in now against the recording
  std::vector<WholeBeat> beats_;
};

}  // namespace dance
