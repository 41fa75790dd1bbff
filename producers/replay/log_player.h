// LogPlayer: plays an LCM log, packed or not, onto a bus as if its dancers were live: events at
// their recorded intervals (divided by the speed), by absolute deadlines; poses, the beats they
// were danced to, voices, touches and what was felt are stamped anew with this house's clock.
// Reports (STATS, GUEST, STAGE_TIME), what programs say of themselves (VOICE_STATE: so a voice that
// is replayed is told from a live one), what is not ours, and voices at another speed are left out
// and counted.
//
// Units/frames: speed 1 = as recorded.
// Ownership:    owns the log; refers to the bus and the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      damaged stretches of the log are skipped (UnpackedLog counts the bytes, and the
//               packed poses that are lost with them); undecodable messages are counted. A log that
//               cannot be read on ends, and ended() says why.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/bus/signal_port.h"
#include "core/net/poller.h"
#include "formats/log/unpacked_log.h"

namespace dance {

struct LogPlayerOptions {
  double speed = 1.0;
  bool loop = true;
  // Play only these; empty = capture, guest and stage. The house's beats go with its captures.
  std::vector<Where> only;
};

class LogPlayer {
 public:
  struct Counters {
    std::uint64_t played = 0;
    std::uint64_t left_out = 0;
    std::uint64_t undecodable = 0;
    std::uint64_t loops = 0;
    std::uint64_t gaps = 0;  // pauses of over a minute, or jumps back, that were not waited for
  };

  LogPlayer(UnpackedLog log, LogPlayerOptions options, SignalPort& bus, Poller& poller,
            MonoTime start);

  bool is_over() const { return is_over_; }
  Result<void> ended() const { return log_.ended(); }
  const Counters& counters() const { return counters_; }
  // Bytes of the log that are no event; playing it again does not count them again.
  std::uint64_t skipped_bytes() const { return std::max(skipped_bytes_, log_.skipped_bytes()); }
  const LogUnpacker::Counters& unpacking() const {
    return log_.unpacking().lost() >= unpacking_.lost() ? log_.unpacking() : unpacking_;
  }

 private:
  // When the dance of a channel was captured, then and now.
  struct Anchor {
    Channel channel;
    MonoTime then;
    MonoTime now;
  };

  void note_damage();
  MonoTime play(MonoTime now);
  bool read_next();
  bool start_again(MonoTime now);
  void publish(const LogEvent& event, MonoTime deadline);
  MonoTime restamp(const Channel& channel, MonoTime captured, MonoTime deadline);
  template <class Message>
  void publish_as(const Channel& channel, const LogEvent& event, MonoTime deadline);
  bool is_wanted(const Channel& channel) const;
  MonoTime deadline_of(const LogEvent& event) const;

  UnpackedLog log_;
  LogPlayerOptions options_;
  SignalPort& bus_;
  std::optional<LogEvent> next_;
  MonoTime start_;
  std::int64_t first_time_us_ = 0;
  std::int64_t last_time_us_ = 0;
  bool has_first_ = false;
  bool played_this_round_ = false;
  bool is_over_ = false;
  std::vector<Anchor> anchors_;
  Counters counters_;
  std::uint64_t skipped_bytes_ = 0;
  LogUnpacker::Counters unpacking_;
};

}  // namespace dance
