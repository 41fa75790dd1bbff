// Files of avatars, both ways: chunks of this house's to who asks for them, and those of the
// others' that this house wants. What goes out waits while records do, and goes only with a server
// that has said that it knows files: others never see these datagrams but for a few tries.
//
// Units/frames: now is MonoTime of this house's clock.
// Ownership:    refers to the link's context; shares the bytes of what it offers.
// Threads:      none inside; one owner.
// Failure:      foreign and malformed datagrams are rejected; a refusal is handed on.
#pragma once

#include "tunnel/files/file_receiver.h"
#include "tunnel/files/file_sender.h"
#include "tunnel/link/core/link_context.h"

namespace dance {

class LinkFiles {
 public:
  explicit LinkFiles(LinkContext& link);

  // Before the guest's AvatarFile is sent; nullptr takes it back.
  void offer(const GuestId& guest, const FileHash& hash, FileBytes bytes);
  // As FileReceiver's of the same names.
  void fetch(const GuestId& guest, const FileHash& hash, ChunkedFile begin, MonoTime now);
  void drop(const GuestId& guest) { receiver_.drop(guest); }
  bool fetches(const GuestId& guest, const FileHash& hash) const {
    return receiver_.wants(guest, hash);
  }
  void settle(const GuestId& guest, const FileHash& hash, FileVerdict verdict) {
    receiver_.settle(guest, hash, verdict);
  }

  void begin_session();
  // With each ping until the server has answered, or some times in vain.
  void say_terms();
  bool receive(const wire::Opening& opening, MonoTime now);
  void see_round_trip(Duration round_trip, MonoTime now);
  void send_due(MonoTime now);
  MonoTime next_deadline() const;

  const FileReceiverCounters& received() const { return receiver_.counters(); }
  const FileSenderCounters& sent() const { return sender_.counters(); }
  double sending_share() const { return sender_.pace().share(); }

 private:
  bool on_terms(wire::Bytes body);
  bool on_want(wire::Bytes body, MonoTime now);
  bool on_chunk(wire::Bytes body, MonoTime now);
  bool on_refusal(wire::Bytes body, MonoTime now);
  bool may_send() const;
  const GuestId* remote_in(const wire::Slot& slot) const;
  std::optional<wire::Slot> slot_of(const GuestId& guest) const;
  template <class Message>
  void send(const Message& message);

  LinkContext& link_;
  FileReceiver receiver_;
  FileSender sender_;
  FileReceiver::SlotOf slot_of_;
  int tries_left_ = 0;
  bool server_takes_files_ = false;
};

}  // namespace dance
