// Who gets which of the records that come in.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context.
// Threads:      none inside; one owner.
// Failure:      what a datagram does not do right is counted by cause.
#pragma once

#include "tunnel/server/signals/server_feedback.h"

namespace dance {

class ServerInterest {
 public:
  ServerInterest(ServerContext& server, ServerFeedback& feedback)
      : server_(server), feedback_(feedback) {}

  void on_interest(std::size_t session, wire::Bytes body, MonoTime now);
  // After the session's list or the room's roster changed.
  void settle(std::size_t session, MonoTime now);
  // Tells the cluster which guests of other servers any link of the room wants.
  void tell_wanted(ServerRoom& room);
  // Whether a record goes to a receiver; counts those that do not.
  bool take(std::size_t to, const wire::Record& record, MonoTime now);

 private:
  static void settle_voices(ServerSession& session, const ServerRoom& room);
  void set_divider(std::size_t session, std::uint8_t slot, std::uint8_t divider, MonoTime now);

  ServerContext& server_;
  ServerFeedback& feedback_;
};

}  // namespace dance
