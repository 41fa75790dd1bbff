// States at the server: retained while their guest, or the room, is there; told at once, and again
// with each pong until acknowledged.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context.
// Threads:      none inside; one owner.
// Failure:      what a datagram does not do right is counted by cause.
#pragma once

#include "tunnel/server/core/server_context.h"

namespace dance {

class ServerStates {
 public:
  explicit ServerStates(ServerContext& server) : server_(server) {}

  void on_states(std::size_t session, wire::Bytes body, MonoTime now);
  // From another server of the cluster: of a guest of its, or of the room (guest = nullptr).
  void on_remote_state(ServerRoom& room, ServerGuest* guest, const wire::State& state);
  void on_acks(std::size_t session, wire::Bytes body);
  // All that the link has not acknowledged, or of that only what nobody has been told yet.
  void send(std::size_t session, bool only_fresh, std::size_t most_datagrams);
  void send_fresh(ServerRoom& room, MonoTime now);

 private:
  std::optional<wire::StateAck> take(std::size_t session, const wire::State& state, MonoTime now);
  std::optional<wire::StateAck> take_of_room(std::size_t session, const wire::State& state,
                                             MonoTime now);
  bool accept_chat(ServerGuest& guest, const RetainedState& retained, wire::Bytes payload,
                   MonoTime now);
  static void note_place(ServerGuest& guest, const wire::State& state);
  void retain(ServerRoom& room, RetainedState& retained, const wire::State& state);

  ServerContext& server_;
};

}  // namespace dance
