// States of guests, both ways: those of this house are told until the server has them, those of
// the others are heard and acknowledged. What is the room's, or of a further channel, goes on to
// its part.
//
// Units/frames: now is MonoTime of this house's clock.
// Ownership:    refers to the link's context and parts.
// Threads:      none inside; one owner.
// Failure:      impossible values are counted and dropped.
#pragma once

#include "tunnel/link/signals/link_channels.h"
#include "tunnel/link/signals/link_chat.h"
#include "tunnel/link/signals/link_room.h"

namespace dance {

class LinkStates {
 public:
  LinkStates(LinkContext& link, LinkRoom& room, LinkChannels& channels, LinkChat& chat)
      : link_(link), room_(room), channels_(channels), chat_(chat) {}

  void send(LocalGuest& guest, const Skeleton& skeleton, MonoTime now);
  // Avatar, style, placement.
  template <class Message>
  void send(const GuestId& id, wire::StateKind kind, const Message& message, MonoTime now);
  void send(const GuestId& id, const Chat& chat, MonoTime now);
  // Sends the states again that the server has not acknowledged.
  void repeat(MonoTime now);

  bool on_states(wire::Bytes body, MonoTime now);
  bool on_acks(wire::Bytes body);

 private:
  void tell(LocalGuest& guest, wire::StateKind kind, const ReplicatedState& state, MonoTime now);
  bool on_guest_state(const wire::State& state, MonoTime now);
  bool deliver(RemoteGuest& remote, const wire::State& state, MonoTime now);
  template <class Message, class Handler>
  bool deliver_message(const GuestId& id, wire::Bytes payload, const Handler& handler,
                       MonoTime now);

  LinkContext& link_;
  LinkRoom& room_;
  LinkChannels& channels_;
  LinkChat& chat_;
};

}  // namespace dance
