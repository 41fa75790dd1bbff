// Limits for the holder of one key, so that nobody takes the places of everybody else: sessions,
// rooms, places in a room, traffic and memory for avatars.
//
// Ownership: quota_of() returns plain values. KeyUses is a table of fixed size; it allocates
//            nothing after construction.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/assert.h"
#include "core/base/token_bucket.h"
#include "tunnel/server/core/access.h"

namespace dance {

struct ServerLimits;

struct KeyQuota {
  std::size_t sessions = 0;
  std::size_t rooms = 0;  // in use at a time that were opened with the key
  // Limits in one room: guests through this server, guests through all servers of a cluster, and
  // links of this server without guests.
  std::size_t guests = 0, guests_of_cluster = 0, listeners = 0;
  std::size_t files = 0, file_bytes = 0;  // avatars in memory
  // How many times the traffic of one session.
  double traffic = 1.0;
};
// The key of one person gets little. A key that a room shares gets at most half of everything. The
// key of the server's own machine has no limit of its own.
KeyQuota quota_of(const Access& access, const ServerLimits& limits);

// Current use of each key, by the key's name.
class KeyUses {
 public:
  // Has an entry per session, as each session may use another key.
  explicit KeyUses(std::size_t sessions) : uses_(sessions) {}

  // The index of the key's use, for leave() and admits(). A key that leaves and returns keeps its
  // token buckets, unless another key needed the entry.
  std::size_t join(const Access& access, const ServerLimits& limits);
  void leave(std::size_t use) {
    DANCE_ASSERT(uses_[use].sessions > 0, use);
    --uses_[use].sessions;
    uses_[use].left = ++leaves_;
  }
  std::size_t sessions_of(const GuestId& key) const {
    const auto found =
        std::ranges::find_if(uses_, [&](const Use& use) { return use.key == key && use.was_used; });
    return found == uses_.end() ? 0 : found->sessions;
  }
  // Counts a datagram: false where the key sends more than it may.
  bool admits(std::size_t use, std::size_t datagram_bytes, MonoTime now) {
    return uses_[use].datagrams.take(1.0, now) &&
           uses_[use].bytes.take(static_cast<double>(datagram_bytes), now);
  }

 private:
  struct Use {
    GuestId key;
    bool was_used = false;
    std::size_t sessions = 0;
    std::uint64_t left = 0;  // number of the last leave()
    TokenBucket datagrams, bytes;
  };
  std::vector<Use> uses_;
  std::uint64_t leaves_ = 0;
};

}  // namespace dance
