// What has come from the other side of a session, what of it could not be decoded, and when the
// other side is told so. A link also asks here for intra frames, which go with the acknowledgement.
//
// Units/frames: datagram numbers are 16 bit and wrap; MonoTime of the owner's clock.
// Ownership:    plain value of fixed size; never allocates.
// Threads:      none inside.
// Failure:      a request for more intra frames than fit is refused: the next failure asks again.
#pragma once

#include <cstdint>

#include "core/base/fixed_list.h"
#include "core/base/time.h"
#include "tunnel/session/ack_window.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

class AckTracker {
 public:
  using Slots = FixedList<std::uint8_t, wire::kMaxGuestsPerRoom>;

  bool has(std::uint16_t number) const { return window_.has(number); }
  bool has_any() const { return window_.has_any(); }
  const LossMeter& loss() const { return window_.loss(); }

  // A datagram that came and decoded,
  void note(std::uint16_t number) { window_.note(number); }
  // or one in which the poses of some guests did not. False where it cannot be acknowledged so.
  bool note_except(std::uint16_t number, const Slots& failed);

  // The other side is to be told by `due`; at once when its acknowledgement would tell too much.
  void owe(MonoTime due, bool is_clean, MonoTime now);
  bool owes() const { return due_.is_set(); }
  bool want_intra_frame(std::uint8_t slot, MonoTime now);
  MonoTime due() const { return due_; }
  MonoTime told_at() const { return told_at_; }
  // Whether a datagram that leaves now should tell. On a clean path it can wait for the next one,
  // unless much has come since.
  bool is_ripe(MonoTime now, bool is_clean) const;
  // Bytes beyond the part of the header that always fits.
  std::size_t extra_bytes() const { return 2 + 2 * excepts_.size() + wants_.size(); }

  // Writes the acknowledgement into a header;
  void fill(wire::RecordsHeader& header) const;
  // and the requests, after which nothing is owed.
  void tell(wire::RecordsHeader& header, MonoTime now);

  // Where nothing is lost, an acknowledgement waits: every second pose at 60 Hz brings one.
  static constexpr Duration kCleanGap = Duration::ms(25);

 private:
  // An acknowledgement tells of 33 datagrams: half of them come at most before one is made. On a
  // clean path it is hardly lost: there nearly all, so that it goes along with the next pose in a
  // room of thirty too, where alone it would cost three times as much.
  static constexpr int kMostUntold = 16;
  static constexpr int kMostUntoldOnClean = 31;
  struct Except {
    std::uint16_t number;
    std::uint8_t slot;
  };

  AckWindow window_;
  FixedList<Except, wire::kMaxAckExcepts> excepts_;
  FixedList<std::uint8_t, wire::kMaxWants> wants_;
  MonoTime due_;      // set: there is something to tell
  MonoTime told_at_;  // when it was last told,
  int untold_ = 0;    // and datagrams with records since then
};

}  // namespace dance
