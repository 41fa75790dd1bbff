// Whether links are still there: pings are answered, silent sessions end, and links are told when
// their session is over.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context and parts.
// Threads:      none inside; one owner.
// Failure:      pings that are malformed, or of another session, are rejected or answered with a
//               goodbye.
#pragma once

#include "tunnel/server/server_admission.h"
#include "tunnel/server/server_sync.h"
#include "tunnel/server/signals/server_pace.h"

namespace dance {

class ServerKeepalive {
 public:
  ServerKeepalive(ServerContext& server, ServerAdmission& admission, ServerFeedback& feedback,
                  ServerPace& pace, ServerSync& sync)
      : server_(server), admission_(admission), feedback_(feedback), pace_(pace), sync_(sync) {}

  void on_ping(std::size_t session, wire::Bytes body, MonoTime received, MonoTime now);
  // Ends sessions that fell silent; the others are told again what their receivers have.
  void sweep(MonoTime now);
  // The link says hello at once, instead of when it has heard nothing for long.
  void send_goodbye(PeerId peer);
  void send_goodbyes();
  // The clock has become another: links begin anew.
  void end_sessions();

 private:
  ServerContext& server_;
  ServerAdmission& admission_;
  ServerFeedback& feedback_;
  ServerPace& pace_;
  ServerSync& sync_;
};

}  // namespace dance
