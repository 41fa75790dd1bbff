// Who is in a room, told to a peer whose key opens it, whether it is there or not: no session
// begins, no room opens, and nobody in it notices.
//
// Units/frames: MonoTime of the server's clock.
// Ownership:    refers to the server's context and parts.
// Threads:      none inside; one owner.
// Failure:      who may not know is told so, and counted; who asks too often is not answered.
#pragma once

#include "tunnel/server/server_admission.h"
#include "tunnel/wire/wire_room.h"

namespace dance {

class ServerRoomAnswers {
 public:
  ServerRoomAnswers(ServerContext& server, const ServerAdmission& admission);

  void on_question(PeerId from, const Access& access, wire::Bytes body, MonoTime now);

 private:
  wire::RoomAnswer answer_to(const wire::RoomQuestion& question, const Access& access,
                             MonoTime now) const;

  ServerContext& server_;
  const ServerAdmission& admission_;
  std::array<TokenBucket, 64> questions_;  // by key: names that fall on one place share it
};

}  // namespace dance
