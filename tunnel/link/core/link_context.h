// What the parts of a link share: what it was told, whom it tells, its guests and those of the
// others, and the session of now.
//
// Units/frames: as in its members.
// Ownership:    owns all but the sink, which must outlive it; parts refer to it.
// Threads:      none inside; one owner.
// Failure:      as in its members.
#pragma once

#include "core/base/assert.h"
#include "core/base/token_bucket.h"
#include "core/net/clock_mapper.h"
#include "core/net/datagram_sink.h"
#include "tunnel/link/core/link_guests.h"
#include "tunnel/link/core/link_options.h"
#include "tunnel/session/stream.h"

namespace dance {

struct LinkContext {
  LinkContext(const LinkOptions& link_options, LinkHandlers link_handlers, DatagramSink& to)
      : options(link_options), handlers(std::move(link_handlers)), sink(to) {}

  bool is_connected() const { return state == LinkState::kConnected; }
  // Neither to the server nor from there to the worst of the others is much lost.
  bool is_path_clean() const { return path.is_known && path.loss < 0.002; }
  void send(wire::Bytes datagram) {
    DANCE_ASSERT(!datagram.empty());
    ++counters.datagrams_out;
    counters.bytes_out += datagram.size() + wire::kSealOverhead;
    sink.send({}, datagram);
  }
  void send_state(const wire::State& own) {
    StateWriter writer([this](wire::Bytes bytes) { send(bytes); });
    writer.add(own);
    ++counters.states_sent;
  }
  // Ours, and the server is not known to have it.
  bool is_due(const ReplicatedState& own, const wire::StateName& name,
              const wire::Slot& slot) const {
    if (name.kind == wire::StateKind::kAvatarFile && !server_knows_files) return false;
    return own.version != 0 && !stream.states.has(name, slot.slot, own.version);
  }

  LinkOptions options;
  LinkHandlers handlers;
  DatagramSink& sink;
  LinkCounters counters;
  ClockMapper clock;
  LocalGuests locals;
  RemoteGuests remotes;
  LinkState state = LinkState::kConnecting;
  CodecName codec;
  Stream stream;
  bool may_remove = false;          // the server has said so in this session
  bool server_knows_files = false;  // it has said file terms in this session
  PathStats path;
  TokenBucket state_changes{10.0, 20.0};  // told at once; more goes with the pings
};

}  // namespace dance
