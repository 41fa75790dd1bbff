// Records from the server to this house: decoded, mapped into this house's clock and handed on;
// what came and what did not decode is acknowledged.
//
// Units/frames: now and received are MonoTime of this house's clock.
// Ownership:    refers to the link's context and parts. Receiving poses never allocates.
// Threads:      none inside; one owner.
// Failure:      what does not decode, or is late, is dropped and counted by cause.
#pragma once

#include "tunnel/link/signals/link_channels.h"
#include "tunnel/link/signals/link_sender.h"

namespace dance {

class LinkReceiver {
 public:
  LinkReceiver(LinkContext& link, LinkSender& sender, LinkChannels& channels)
      : link_(link), sender_(sender), channels_(channels) {}

  // False for a malformed datagram; nothing of it is taken.
  bool on_records(wire::Bytes body, MonoTime received, MonoTime now);
  // When the newest datagram with records came.
  MonoTime heard_records() const { return heard_records_; }

 private:
  // False for a pose that did not decode.
  bool on_record(wire::Record record, MonoTime received, MonoTime now);
  void on_hands(const wire::Record& record, const GuestId& id, MonoTime capture, MonoTime now);
  bool decode(RemoteGuest& remote, const wire::Record& record, MonoTime now);
  void want_intra_frame(RemoteGuest& remote, MonoTime now);

  LinkContext& link_;
  LinkSender& sender_;
  LinkChannels& channels_;
  MonoTime heard_records_;
  Pose decoded_;
  Hands decoded_hands_;
};

}  // namespace dance
