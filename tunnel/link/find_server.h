// FoundServer: where a server is, and the house's key to it, for a program that starts. A resolver
// that is silent, or that does not know the name yet (as at boot), delays a house that has a key by
// some seconds at most: its link resolves the name again.
//
// Threads: waits for the resolver: not for the pose path.
// Failure: find_server() names the server and the cure; a signal that stops the poller ends the
//          wait.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "tunnel/link/core/link_options.h"
#include "tunnel/link/link_key.h"

namespace dance {

struct FoundServer {
  std::vector<Address> addresses;  // none: not known yet, and `why`
  std::string why;
  LinkKey key;
};

// `look_up` is LinkOptions::look_up of this server.
Result<FoundServer> find_server(const std::string& server,
                                const std::function<Result<std::vector<Address>>()>& look_up,
                                const wire::RoomName& room, const GuestId& first_guest,
                                const LinkKeySource& source, Poller& poller);

// Resolves a server's name; not set for a numeric address, which never changes.
std::function<Result<std::vector<Address>>()> look_up_of(const std::string& server);

}  // namespace dance
