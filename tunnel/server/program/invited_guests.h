// The guests of a server that runs who come with an invitation: what their houses make of it goes
// into the server's own file of keys, and counts at once. In a cluster there are none, as the other
// servers would not know the key.
//
// Units/frames: none.
// Ownership:    refers to keys, poller and server, which must outlive it but for the server.
// Threads:      the poller's; the file is written in another.
// Failure:      a file that cannot be written is told, and the house with it.
#pragma once

#include "tunnel/server/program/invitation_keeper.h"
#include "tunnel/server/program/server_keys.h"
#include "tunnel/server/server.h"

namespace dance {

// New keys count at once, and those that are gone no more.
void read_keys_again(ServerKeys& keys, Server& server);

class InvitedGuests {
 public:
  InvitedGuests(ServerKeys& keys, WakeEvent wake, Poller& poller);
  // Before the first datagram.
  void set_server(Server& server) { server_ = &server; }
  // As ServerOptions has it.
  void on_binding(PeerId peer, const KeyEntry& entry, const PublicKey& house);

 private:
  void on_kept(const InvitationKeeper::Kept& kept);

  ServerKeys& keys_;
  Server* server_ = nullptr;
  InvitationKeeper keeper_;
};

}  // namespace dance
