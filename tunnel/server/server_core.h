// The tunnel's server as a state machine: datagrams in, datagrams out. Forwards each guest's newest
// pose to everybody else in the room without looking into it; keeps who is in which room and the
// newest states (bodies, music, further channels) for those who come later.
//
// Speaks with peers that have proved who they are: the caller of receive() has checked their keys.
// Its parts stand beside it (who is here) and in signals/ (what they send, and what their lines
// bear); this class dispatches to them, and says in which order a turn ends and when the next is
// due. In a cluster another server is a session too (server_remotes.h beside it), which is told
// nothing here: is_remote().
//
// Units/frames: now and received are MonoTime of the server's clock, which is the tunnel's clock.
// Ownership:    owns sessions and rooms, all made at construction; the sink must outlive it. Taking
//               and forwarding records never allocates.
// Threads:      none inside; one owner.
// Failure:      whatever a datagram does not do right is counted by cause; nothing from outside can
//               make it stop or grow.
#pragma once

#include <functional>
#include <vector>

#include "tunnel/server/server_keepalive.h"
#include "tunnel/server/server_remotes.h"
#include "tunnel/server/server_removals.h"
#include "tunnel/server/server_room_answers.h"
#include "tunnel/server/signals/server_files.h"
#include "tunnel/server/signals/server_voice.h"

namespace dance {

class ServerCore {
 public:
  using RandomU64 = ServerAdmission::RandomU64;

  ServerCore(const ServerLimits& limits, RandomU64 random, PeerSink& sink)
      : server_(limits, sink),
        admission_(server_, slots_, feedback_, interest_, std::move(random)) {}
  ServerCore(const ServerCore&) = delete;
  ServerCore& operator=(const ServerCore&) = delete;

  // One datagram that came in at `received`, and what the sender's key lets it do.
  void receive(PeerId from, const Access& access, wire::Bytes datagram, MonoTime received,
               MonoTime now);
  // The sealed session has ended: so has what it had here.
  void forget(PeerId peer);
  // Sends what the datagrams of this turn left to send. Call after the last of them.
  void end_turn(MonoTime now);
  // Drops sessions that fell silent, sends what has waited; returns when to call again, MonoTime()
  // = not before a datagram.
  MonoTime tick(MonoTime now);
  // When tick() is due, which may be earlier after a turn.
  MonoTime next_deadline() const;
  // The clock has become another: all sessions end, and their links begin anew.
  void end_sessions();
  // Tells everybody that the server ends.
  void send_goodbye() { keepalive_.send_goodbyes(); }

  // As ServerAdmission's.
  void set_reserved(std::function<bool(const GuestId&)> is_reserved) {
    admission_.set_reserved(std::move(is_reserved));
  }

  // Receives what belongs into the audit log, by peer.
  void set_on_audit(std::function<void(PeerId, const AuditEvent&)> on_audit) {
    server_.on_audit = std::move(on_audit);
  }

  // Of a cluster, before the first datagram: the port that tells the other servers, and what they
  // tell. The port must outlive this.
  void join(ClusterPort& cluster) { server_.cluster = &cluster; }
  // Where its links can go when it ends: they are told.
  void set_other_servers(const wire::ServerList& servers) { sync_.set_other_servers(servers); }
  ServerRemotes& remotes() { return remotes_; }
  const ServerRemotes& remotes() const { return remotes_; }
  ServerRemovals& removals() { return removals_; }

  const ServerCounters& counters() const { return server_.counters; }
  std::size_t session_count() const { return server_.by_peer.size(); }
  const ServerFiles& files() const { return files_; }
  std::size_t room_count() const;
  std::size_t guest_count() const;
  std::size_t listener_count() const;
  // For the status line and tests.
  const std::vector<ServerSession>& sessions() const { return server_.sessions; }
  const std::vector<ServerRoom>& rooms() const { return server_.rooms; }
  const std::vector<RemoteReceivers>& remote_receivers() const { return server_.remote_receivers; }

 private:
  void on_session_datagram(std::size_t session, const wire::Opening& opening, MonoTime received,
                           MonoTime now);
  void tell_rosters(MonoTime now);
  void tell_wanted();
  bool sync_newcomers(MonoTime now);
  void tell_fresh_states(MonoTime now);
  void sweep(MonoTime now);

  ServerContext server_;
  ServerSlots slots_{server_};
  ServerFeedback feedback_{server_};
  ServerInterest interest_{server_, feedback_};
  ServerPace pace_{server_, interest_};
  ServerStates states_{server_};
  ServerForwarder forwarder_{server_, feedback_, interest_, states_};
  ServerSync sync_{server_, states_, forwarder_};
  ServerAdmission admission_;
  ServerRemovals removals_{server_, admission_};
  ServerRoomAnswers room_answers_{server_, admission_};
  ServerKeepalive keepalive_{server_, admission_, feedback_, pace_, sync_};
  ServerFiles files_{server_};
  ServerVoice voice_{server_};
  ServerRemotes remotes_{server_,   slots_,  admission_, forwarder_,
                         feedback_, states_, files_,     voice_};
  MonoTime next_sweep_;
  std::uint64_t sweeps_ = 0;
};

}  // namespace dance
