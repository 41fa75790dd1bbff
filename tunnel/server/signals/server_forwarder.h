// The way of records through the server: checked against their session and sequence, and forwarded
// undecoded, with others in one datagram where they come within the room's window. The newest
// intra frame of each guest is retained for those who come later.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context and parts. Never allocates.
// Threads:      none inside; one owner.
// Failure:      what a datagram does not do right is counted by cause.
#pragma once

#include "tunnel/server/signals/server_interest.h"
#include "tunnel/server/signals/server_states.h"

namespace dance {

class ServerForwarder {
 public:
  ServerForwarder(ServerContext& server, ServerFeedback& feedback, ServerInterest& interest,
                  ServerStates& states)
      : server_(server), feedback_(feedback), interest_(interest), states_(states) {}

  void on_records(std::size_t session, wire::Bytes body, MonoTime received, MonoTime now);
  // From another server of the cluster, with whole numbers and the slot that its guest has here.
  void on_remote_record(std::size_t session, wire::Record record, MonoTime now);
  // Bundles and feedback; not to who has no roster yet.
  void flush_due(MonoTime now);
  void send_retained(std::size_t to, std::uint8_t slot, MonoTime now);
  // It may be lost, and nothing newer comes of who does not move: until the receiver has some pose.
  void repeat_retained(std::size_t to, MonoTime now);

 private:
  void on_record(std::size_t session, wire::Record record, MonoTime received, MonoTime now);
  bool is_timely(const wire::Record& record, MonoTime received);
  void take(std::size_t session, ServerGuest& guest, const wire::Record& record, MonoTime received,
            MonoTime now);
  void on_channel_record(std::size_t session, wire::Record record, MonoTime now);
  void take_channel(std::size_t session, ServerGuest& guest, wire::Record record, MonoTime now);
  void retain(ServerGuest& guest, const wire::Record& record);
  void forward(std::size_t from, const wire::Record& record, MonoTime now);
  void add(std::size_t to, const wire::Record& record, MonoTime now);
  void put(std::size_t to, const wire::Record& record, MonoTime now);
  void repeat_before(std::size_t member, const ServerGuest& guest, const wire::Record& next,
                     MonoTime now);
  bool is_bundle_due(const ServerSession& session, MonoTime now) const;
  void flush_bundle(std::size_t session, MonoTime now);
  void send_records(std::size_t session, MonoTime now);

  ServerContext& server_;
  ServerFeedback& feedback_;
  ServerInterest& interest_;
  ServerStates& states_;
};

}  // namespace dance
