// What a crowd did in a span of time: counts that add up over guests, threads and seconds.
//
// Units/frames: a delivery is one pose heard by one other guest. Bytes have the seal in them, and
//               the headers of IP and UDP.
// Ownership:    plain value of fixed size.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <cstdint>

#include "core/base/histogram.h"

namespace dance {

struct CrowdTally {
  std::uint64_t sent = 0;
  std::uint64_t unsent = 0;   // due while a guest had no session
  std::uint64_t skipped = 0;  // due, and this machine had no time for them
  std::uint64_t delivered = 0;
  std::uint64_t near_delivered = 0, near_missed = 0;  // of them, of the nearest guests
  std::uint64_t missed = 0;  // sent to somebody who was there, and not heard within 1 to 2 s
  std::uint64_t lost = 0;    // of missed, by the links' own count: without what nobody asked for
  std::uint64_t undecodable = 0;
  std::uint64_t bytes_up = 0, bytes_down = 0;
  std::uint64_t datagrams_up = 0, datagrams_down = 0;
  std::uint64_t lapses = 0;
  std::uint64_t reconnects = 0;
  std::uint64_t left = 0;     // of their own will, to come back
  std::uint64_t present = 0;  // guests in a session at the end of each second
  Histogram latency;          // of deliveries

  void add(const CrowdTally& more) {
    sent += more.sent;
    unsent += more.unsent;
    skipped += more.skipped;
    delivered += more.delivered;
    missed += more.missed;
    near_delivered += more.near_delivered;
    near_missed += more.near_missed;
    lost += more.lost;
    undecodable += more.undecodable;
    bytes_up += more.bytes_up;
    bytes_down += more.bytes_down;
    datagrams_up += more.datagrams_up;
    datagrams_down += more.datagrams_down;
    lapses += more.lapses;
    reconnects += more.reconnects;
    left += more.left;
    present += more.present;
    latency.add(more.latency);
  }
  double share() const { return share_of(delivered, missed); }
  double near_share() const { return share_of(near_delivered, near_missed); }
  double far_share() const { return share_of(delivered - near_delivered, missed - near_missed); }

 private:
  // 1 where nothing was due.
  static double share_of(std::uint64_t came, std::uint64_t did_not) {
    const std::uint64_t due = came + did_not;
    return due == 0 ? 1.0 : static_cast<double>(came) / static_cast<double>(due);
  }
};

}  // namespace dance
