// Voices of this house's guests to the server, and those of the others from it. What the guests say
// in a turn goes at its end, behind the poses; what comes is handed on as it comes, in whatever
// order: the player has a buffer, and finds losses by the sequence.
//
// Units/frames: now is MonoTime of this house's clock.
// Ownership:    refers to the link's context. Never allocates.
// Threads:      none inside; one owner.
// Failure:      what cannot be sent now, or is no voice, is dropped and counted; nothing is sent
//               again. No packet is looked into.
#pragma once

#include "tunnel/link/core/link_context.h"
#include "tunnel/link/signals/link_sender.h"
#include "tunnel/wire/wire_voice.h"

namespace dance {

class LinkVoice {
 public:
  LinkVoice(LinkContext& link, LinkSender& sender) : link_(link), sender_(sender) {}

  // The guest has a slot.
  void send(LocalGuest& guest, const Voice& voice, MonoTime now);
  // After the records of the turn.
  void flush_due(MonoTime now);
  MonoTime next_deadline() const { return size_ > 0 ? due_ : MonoTime(); }
  // What waits is of a session that is over.
  void clear() { size_ = 0; }

  // False for a malformed datagram; nothing of it is taken.
  bool on_voices(wire::Bytes body, MonoTime now);

 private:
  void on_voice(const wire::VoiceRecord& record, MonoTime now);
  void flush();

  LinkContext& link_;
  LinkSender& sender_;
  std::array<std::uint8_t, wire::kMaxPlain> bytes_;  // the next datagram
  std::size_t size_ = 0;
  MonoTime due_;
  Voice heard_;
};

}  // namespace dance
