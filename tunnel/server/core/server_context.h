// What the parts of the server share: sessions and rooms, who has something to be sent, and the way
// out.
//
// Units/frames: MonoTime of the server's clock; sessions and rooms by index.
// Ownership:    owns all but the sink, which must outlive it; all made at construction.
// Threads:      none inside; one owner.
// Failure:      none; what is rejected is counted by cause.
#pragma once

#include <functional>
#include <map>
#include <unordered_map>
#include <vector>

#include "tunnel/server/core/audit_event.h"
#include "tunnel/server/core/key_quota.h"
#include "tunnel/server/core/removal_bans.h"
#include "tunnel/server/core/server_state.h"
#include "tunnel/wire/wire_servers.h"

namespace dance {

struct ServerContext {
  ServerContext(const ServerLimits& of_server, PeerSink& to);

  void reject(ServerReject cause) { ++counters.rejected[static_cast<std::size_t>(cause)]; }
  void send(PeerId to, wire::Bytes bytes);
  // Passes an event of this peer to the audit log, where there is one.
  void audit(PeerId peer, const AuditEvent& event) const {
    if (on_audit) on_audit(peer, event);
  }
  // Of this session; nullptr where the slot is another's, or nobody's.
  ServerGuest* guest_of(std::size_t session, std::uint8_t slot);
  bool is_newcomer(std::size_t session) const;
  // Why the server, or the key, has no place for another session or room; nullopt: it has.
  std::optional<wire::Refusal> full_for(const Access& access, bool wants_session,
                                        bool wants_room) const;
  // Counts a datagram of a link: false where its session or its key sends more than it may.
  bool admits(ServerSession& session, std::size_t datagram_bytes, MonoTime now);
  // Of a guest that came through a link of this server's.
  bool is_local(const ServerGuest& guest) const { return !sessions[guest.owner].is_remote(); }
  // Its roster or its states are to be told at the end of the turn.
  void mark_changed(ServerRoom& room);

  ServerLimits limits;
  PeerSink& sink;
  std::function<void(PeerId, const AuditEvent&)> on_audit;
  ClusterPort* cluster = nullptr;  // must outlive it
  std::vector<ServerSession> sessions;
  std::vector<ServerRoom> rooms;
  std::vector<RemoteReceivers> remote_receivers;  // as many as there may be
  std::unordered_map<PeerId, std::size_t> by_peer;
  std::map<wire::RoomName, std::size_t> by_room;  // those in use
  std::vector<std::size_t> newcomers;             // sessions that know nothing of their room yet
  std::vector<std::size_t> bundled;               // sessions with a bundle under way
  std::vector<std::size_t> reporting;             // sessions with feedback due
  std::vector<std::size_t> speaking;              // sessions with voices to be sent
  std::vector<std::size_t> changed_rooms;
  wire::ServerList other_servers;  // of a cluster, as links reach them
  RemovalBans bans;
  KeyUses keys;
  ServerCounters counters;
};

}  // namespace dance
