// An index to damage in tests, and its checksum as docs/replay.md describes it, so that damage
// comes behind it.
//
// Units/frames: as formats/replay/replay_index.h.
// Ownership:    returns values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "formats/replay/replay_index.h"

namespace dance::test {

inline MonoTime minute_and(double s) { return MonoTime() + Duration::seconds(60.0 + s); }

inline ReplayIndex some_index() {
  ReplayIndex index;
  index.log = {100'000, 1'700'000'000'000'000'000, 0x0123456789abcdef};
  index.clock_id = 7;
  index.wall_ahead_us = 1'700'000'000'000'000;
  index.begin = minute_and(0.0);
  index.end = minute_and(20.0);
  index.guests.push_back({*GuestId::parse("alice"), minute_and(0.0), minute_and(20.0), 1200});
  index.guests.push_back({*GuestId::parse("bob"), minute_and(3.0), minute_and(19.0), 900});
  index.gaps.push_back({1, minute_and(7.0), minute_and(8.0)});
  index.gaps_left_out = 2;
  for (int beat = 0; beat < 8; ++beat)
    index.beats.push_back({static_cast<double>(beat), minute_and(0.5 * beat), 4});
  index.density = {60, 120, 90, 120};
  index.checkpoints.push_back({});
  index.checkpoints.push_back({50'000, 40'000, 1'700'000'070'000'000, {1, 2, 3, 4, 5}});
  index.checkpoints.push_back({90'000, 80'000, 1'700'000'079'000'000, {6, 7}});
  return index;
}

constexpr std::size_t kIndexChecksum_bytes = 8;

inline void seal_index(std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < kIndexChecksum_bytes) return;
  const std::size_t size = bytes.size() - kIndexChecksum_bytes;
  std::uint64_t hash = 0xcbf29ce484222325;
  std::size_t at = 0;
  for (; size - at >= 8; at += 8) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < 8; ++i) word |= std::uint64_t{bytes[at + i]} << (8 * i);
    hash = (hash ^ word) * 0x100000001b3;
  }
  for (; at < size; ++at) hash = (hash ^ bytes[at]) * 0x100000001b3;
  hash ^= hash >> 29;
  for (std::size_t i = 0; i < 8; ++i) bytes[size + i] = static_cast<std::uint8_t>(hash >> (8 * i));
}

}  // namespace dance::test
