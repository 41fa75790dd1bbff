// Who is at the other end of a sealed session, and where datagrams for it go: the seam between the
// server's state machine and what seals its datagrams. The seal has checked the peer's key, so
// that a PeerId proves who speaks, whatever address its datagrams come from.
//
// Units/frames: bytes of inner datagrams, docs/wire-format.md.
// Ownership:    send() copies or passes on the bytes before it returns.
// Threads:      the caller's.
// Failure:      none here; the carrier counts what could not be sent.
#pragma once

#include <cstdint>
#include <span>

namespace dance {

// Names one sealed session from its begin to its end; never used twice by one server. 0 = none.
using PeerId = std::uint64_t;

class PeerSink {
 public:
  virtual ~PeerSink() = default;
  virtual void send(PeerId to, std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace dance
