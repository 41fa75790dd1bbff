// What a host may do to a guest: remove it from the room. Its session ends, and it is refused for a
// while (tunnel/server/core/removal_bans.h). In a cluster all servers are told, so that it comes
// back through none of them.
//
// Units/frames: MonoTime of the server's clock.
// Ownership:    refers to the server's context and parts.
// Threads:      none inside; one owner.
// Failure:      who may not is told so, and counted.
#pragma once

#include "tunnel/server/server_admission.h"

namespace dance {

class ServerRemovals {
 public:
  ServerRemovals(ServerContext& server, ServerAdmission& admission)
      : server_(server), admission_(admission) {}

  // Of a link: it asks that a guest of its room be removed.
  void on_request(std::size_t session, wire::Bytes body, MonoTime now);
  // Of another server of the cluster, whose link has a host's key.
  void on_notice(const wire::RoomName& room, const RemovalNotice& notice, MonoTime now);
  // What the link's key lets it do; nothing where that is no more than a guest's.
  void tell_rights(std::size_t session);

 private:
  wire::RemovalResult remove(std::size_t session, const GuestId& guest, MonoTime now);
  void end(std::size_t session, const GuestId& by, MonoTime now);

  ServerContext& server_;
  ServerAdmission& admission_;
};

}  // namespace dance
