// What receivers have of each guest and what they lack: acknowledgements and requests for intra
// frames come in from receivers, feedback goes out to senders, not more often than they can use it.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context.
// Threads:      none inside; one owner.
// Failure:      what a datagram does not do right is counted by cause.
#pragma once

#include "tunnel/server/core/server_context.h"

namespace dance {

class ServerFeedback {
 public:
  explicit ServerFeedback(ServerContext& server) : server_(server) {}

  void on_acks(std::size_t session, const wire::Acks& acks, MonoTime now);
  void on_want(std::size_t session, std::uint8_t slot, MonoTime now);
  void want_intra_frame(ServerGuest& guest, MonoTime now);
  void want_intra_frames_for(std::size_t newcomer, MonoTime now);
  void schedule(std::size_t session, MonoTime now);
  // What was said may be lost.
  void repeat(std::size_t session, MonoTime now);
  // False where there is nothing new to tell.
  bool fill(std::size_t session, MonoTime now, wire::Feedback& feedback);
  // To another server, about its guests.
  void tell_remote(std::size_t session, MonoTime now);
  // From another server, about a guest of this one.
  void on_remote_feedback(std::size_t session, std::uint8_t slot, const RemoteFeedback& feedback,
                          MonoTime now);

 private:
  void schedule(std::size_t session, MonoTime at, Duration waits, Duration gap);
  bool is_receiver(std::size_t member, std::size_t sender, MonoTime now) const;
  ReceiverSummary receivers_of(std::size_t session, std::uint8_t slot, MonoTime now) const;
  PathFeedback path_of(std::size_t session, MonoTime now) const;
  wire::GuestFeedback about(std::size_t session, std::uint8_t slot, MonoTime now) const;
  bool count_intra_frame(std::size_t session, ServerGuest& guest, MonoTime now);

  ServerContext& server_;
};

}  // namespace dance
