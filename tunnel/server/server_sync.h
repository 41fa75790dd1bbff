// What links are told of their room: all of it when they come, and with each ping again what they
// have not acknowledged.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context and parts.
// Threads:      none inside; one owner.
// Failure:      none; what does not fit into one turn goes with the next pings.
#pragma once

#include "tunnel/server/signals/server_forwarder.h"
#include "tunnel/server/signals/server_states.h"

namespace dance {

class ServerSync {
 public:
  ServerSync(ServerContext& server, ServerStates& states, ServerForwarder& forwarder)
      : server_(server), states_(states), forwarder_(forwarder) {}

  // To a link that knows nothing of its room yet.
  void send_all(std::size_t newcomer, MonoTime now);
  void repeat(std::size_t session, const wire::Ping& ping, MonoTime now);
  void repeat_states(std::size_t session);
  void send_roster(std::size_t session);
  // Of a cluster: where links can go when this server ends.
  void set_other_servers(const wire::ServerList& servers);

 private:
  void send_servers(const ServerSession& session);

  ServerContext& server_;
  ServerStates& states_;
  ServerForwarder& forwarder_;
};

}  // namespace dance
