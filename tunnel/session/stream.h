// One session, both ways: which records wait to be sent, what was sent in which datagram, what has
// come, and which states the other side has. A new session begins with a new one:
// `stream = Stream()`.
//
// Units/frames: as in its parts.
// Ownership:    plain value of fixed size; never allocates.
// Threads:      none inside.
// Failure:      as in its parts.
#pragma once

#include "tunnel/session/ack_tracker.h"
#include "tunnel/session/record_bundler.h"
#include "tunnel/session/sent_ring.h"
#include "tunnel/session/state_replicator.h"

namespace dance {

struct Stream {
  RecordBundler bundle;
  SentRing sent;
  AckTracker received;
  StateReplicator states;  // what the other side has of them

  // The next datagram, with the records that wait or without; it counts as sent.
  wire::Bytes write(wire::RecordsHeader& header, bool with_records,
                    std::span<std::uint8_t> buffer) {
    header.has_records = with_records && !bundle.is_empty();
    header.number = sent.commit(header.has_records);
    return bundle.write(header, buffer);
  }
};

}  // namespace dance
