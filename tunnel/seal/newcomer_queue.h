// First handshake datagrams of newcomers that have proved their address and wait for their turn. A
// handshake costs the server some hundred microseconds, so their number a second is limited. The
// obvious queue, first come first served, is full of one attacker's datagrams; this one gives turns
// to networks, and when it is full, drops from the network that has most datagrams in it.
//
// Ownership: keeps copies, of fixed size in all; never allocates after construction.
// Failure:   what is dropped is counted by the caller; the newcomer sends it again.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/time.h"
#include "tunnel/seal/network_turns.h"
#include "tunnel/seal/seal_format.h"

namespace dance {

class NewcomerQueue {
 public:
  // A newcomer that has waited this long sends again.
  static constexpr Duration kLongestWait = Duration::s(2);

  struct Newcomer {
    Address from;
    std::uint64_t id = 0;   // of the session that it wants
    bool is_known = false;  // its network was authenticated lately
    MonoTime since;
    std::size_t size = 0;
    std::array<std::uint8_t, seal::kMaxSealed> bytes;
    seal::Bytes records() const { return {bytes.data(), size}; }
  };
  enum class Pushed : std::uint8_t { kWaits, kWaitsAlready, kOtherDropped, kTooLong };

  NewcomerQueue(std::size_t places, std::uint64_t secret);

  Pushed push(const Address& from, std::uint64_t id, seal::Bytes records, bool is_known,
              MonoTime now);
  // Removes the newcomer whose networks have waited longest for a turn, of all or of those that are
  // known; nullptr where there is none. Valid until the next push.
  const Newcomer* pop() { return pop(false); }
  const Newcomer* pop_known() { return known_ > 0 ? pop(true) : nullptr; }
  // How many waited too long and were dropped.
  std::size_t drop_late(MonoTime now);
  std::size_t size() const { return waiting_.size(); }
  bool has_known() const { return known_ > 0; }

 private:
  const Newcomer* pop(bool only_known);
  void remove(std::size_t index);

  NetworkTurns turns_;
  std::vector<Newcomer> places_;
  // In order of arrival: the networks, and the index of the place that holds the rest.
  std::vector<NetworkLevels> networks_;
  std::vector<std::size_t> waiting_;
  std::vector<std::size_t> free_;
  std::size_t known_ = 0;
};

}  // namespace dance
