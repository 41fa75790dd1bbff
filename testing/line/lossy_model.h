// What becomes of each datagram on an emulated line: lost, late, doubled or overtaken. Pure: says
// when and how often to deliver; LossyProxy carries the bytes.
//
// Units/frames: one direction of the line; now is the caller's clock and must not go back.
// Ownership:    shares its traces.
// Threads:      none inside; one owner.
// Failure:      none; each datagram is in counters().
// Source:       bursts by the two-state model of Gilbert (1960) and Elliott (1963).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/random.h"
#include "core/base/time.h"
#include "testing/line/capacity_queue.h"
#include "testing/line/lossy_line.h"

namespace dance {

class LossyModel {
 public:
  struct Counters {
    std::uint64_t offered = 0;
    std::uint64_t forwarded = 0;      // of those offered: delivered once or twice
    std::uint64_t lost = 0;           // by loss= or a trace
    std::uint64_t queue_dropped = 0;  // by queue=: would have waited too long
    std::uint64_t duplicated = 0;
    std::uint64_t reordered = 0;
  };
  // When to deliver: none, one or two times.
  class Fate {
   public:
    std::span<const MonoTime> deliveries() const& { return {times_.data(), count_}; }
    std::span<const MonoTime> deliveries() const&& = delete;  // would dangle
    bool is_lost() const { return count_ == 0; }

   private:
    friend class LossyModel;
    std::array<MonoTime, 2> times_{};
    std::size_t count_ = 0;
  };

  // `stream` makes two directions of one line differ under the same seed.
  LossyModel(LossyWay way, std::uint64_t stream);

  // When the traces begin; else with the first datagram.
  void begin(MonoTime now) { begin_ = now; }

  Fate offer(std::size_t bytes, MonoTime now);
  const Counters& counters() const { return counters_; }

 private:
  bool loses(MonoTime now);
  Duration draw_tail();
  // When it has passed rate and capacity; nothing where the queue was too long.
  std::optional<MonoTime> leaves(std::size_t bytes, MonoTime now);

  LossyWay way_;
  std::optional<CapacityQueue> capacity_;
  Random random_;
  double good_to_bad_ = 0.0;
  double bad_to_good_ = 1.0;
  bool is_bad_ = false;
  MonoTime begin_;
  MonoTime line_free_;       // when the last datagram has left the sender's queue
  MonoTime newest_arrival_;  // order is kept but for reorder= and tail=
  Counters counters_;
};

}  // namespace dance
