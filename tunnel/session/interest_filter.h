// Interest, from the link that has it to the server that acts on it: the list of whom a link wants
// to hear and how often, told until it is acknowledged; and what of one guest's records therefore
// goes to one receiver.
//
// Units/frames: dividers as in tunnel/policy/pose_share.h.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstdint>

#include "tunnel/policy/interest.h"
#include "tunnel/policy/pose_share.h"
#include "tunnel/session/frame_window.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

static_assert(kMaxInterestGuests == wire::kMaxGuestsPerRoom, "each guest of a room can be named");

// The link's side: its newest list, and whether the server has it.
class InterestRequest {
 public:
  // A new session, whose hello has told what counts for those who are not named.
  void begin(std::uint8_t default_divider);
  // False where it is what it was.
  bool change(const wire::InterestList& wanted);
  void take_ack(std::uint32_t version);
  bool is_acked() const { return list_.version == acked_; }
  const wire::InterestList& list() const { return list_; }

 private:
  wire::InterestList list_;
  std::uint32_t acked_ = 0;
};

// The server's side, for one receiver and one guest; with what the receiver has of the guest.
class InterestFilter {
 public:
  // Of the guest: what came, and how often its sender was told to make base frames.
  struct Counts {
    std::uint32_t base_frames = 0;
    std::uint32_t hands = 0;
    std::uint8_t base_log2 = 0;
  };

  explicit InterestFilter(std::uint8_t divider = 1) : divider_(divider) {}

  std::uint8_t divider() const { return divider_; }
  Share share() const { return share_of(divider_); }
  bool wants_any() const { return divider_ != 0; }
  // `stream`: the guest's. True where the receiver needs an intra frame asked for.
  bool set_divider(std::uint8_t divider, std::uint32_t stream);

  FrameWindow& frames() { return frames_; }
  const FrameWindow& frames() const { return frames_; }
  // It has nothing that frames could refer to: the next intra frame is the first it gets.
  bool awaits_intra() const { return awaits_intra_; }
  void await_intra(bool awaits) { awaits_intra_ = awaits; }

  // Whether the record goes to the receiver; counts poses that do not.
  bool take(const wire::Record& record, const Counts& counts);
  // Writes into a pose how many were left out, until the receiver has one that told all of them.
  void tell_left_out(wire::Record& record);

 private:
  bool admits(const wire::Record& record, const Counts& counts) const;

  std::uint8_t divider_;
  bool awaits_intra_ = true;
  std::uint32_t last_sent_ = 0;  // sequence
  bool tells_left_out_ = false;
  std::uint16_t left_out_ = 0;       // poses of this generation
  std::uint16_t last_left_out_ = 0;  // sequence, low half
  FrameWindow frames_;
};

}  // namespace dance
