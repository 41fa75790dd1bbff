// InstrumentRecords: what was measured of each guest over the last minute, for display, and the
// settings that are in force for them.
//
// Units/frames: as lcmtypes/guest_stats_t.lcm and flow_t.lcm say; oldest first.
// Ownership:    plain values; a guest's record is made when the first figures come.
// Threads:      the drawing thread.
// Failure:      a guest who is silent for kForgotten is dropped; at most kMost are kept.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "viewer/instruments/instrument_board.h"

namespace dance {

class GuestRecord {
 public:
  static constexpr std::size_t kSeconds = 60;

  explicit GuestRecord(const GuestId& guest) : guest_(guest) {}
  void add(const GuestStats& stats) { ring_[added_++ % kSeconds] = stats; }

  const GuestId& guest() const { return guest_; }
  std::size_t size() const { return std::min(added_, kSeconds); }
  // 0 is the oldest.
  const GuestStats& at(std::size_t i) const { return ring_[(added_ - size() + i) % kSeconds]; }
  const GuestStats& newest() const { return at(size() - 1); }
  void clear() { added_ = 0; }

  std::optional<FlowSetting> flow;
  std::optional<Playout> playout;

 private:
  GuestId guest_;
  std::array<GuestStats, kSeconds> ring_{};
  std::size_t added_ = 0;
};

class InstrumentRecords {
 public:
  static constexpr std::size_t kMost = InstrumentsMeter::kMaxGuests;
  static constexpr Duration kForgotten = Duration::s(5);
  static constexpr Duration kPlayoutForgotten = Duration::s(3);

  // Once a picture.
  void take(InstrumentBoard& board);
  // By name; those without figures are not among them.
  const std::vector<GuestRecord>& guests() const { return guests_; }
  const GuestRecord* find(const GuestId& guest) const;

 private:
  GuestRecord* record_of(const GuestId& guest);

  std::vector<GuestRecord> guests_;
};

}  // namespace dance
