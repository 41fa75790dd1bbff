// A new connection to one NATS server, as far as messages can pass: TLS and who we are.
//
// Units/frames: none.
// Ownership:    the caller owns what is returned.
// Threads:      any; waits, some seconds at most; once `ends` is set for 0.1 s, but for the lookup
//               of a name.
// Failure:      one line that names the server and the reason.
#pragma once

#include <atomic>

#include "tunnel/nats/messages/nats_channel.h"

namespace dance {

struct NatsHandshake {
  NatsChannel channel;
  std::vector<std::uint8_t> unread;  // what came behind the greeting
};
Result<NatsHandshake> handshake_nats(const NatsOptions& options, const std::string& url,
                                     const std::atomic<bool>& ends);

}  // namespace dance
