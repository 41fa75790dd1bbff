// Records from this house to the server: poses and hands are encoded, stamped in the server's
// clock, and leave together with those of the house's other guests and with what there is to
// acknowledge.
//
// Units/frames: now is MonoTime of this house's clock.
// Ownership:    refers to the link's context. Sending never allocates once a guest is known.
// Threads:      none inside; one owner.
// Failure:      what cannot be sent is dropped and counted, never queued.
#pragma once

#include "tunnel/link/core/link_context.h"

namespace dance {

class LinkSender {
 public:
  explicit LinkSender(LinkContext& link) : link_(link) {}

  // Of a guest that has a slot.
  void send(LocalGuest& guest, const Pose& pose, MonoTime now);
  void send(LocalGuest& guest, const Hands& hands, MonoTime now);
  void add(const wire::Record& record, MonoTime now);

  void flush_acks(MonoTime now);
  void flush_due(MonoTime now);
  MonoTime next_deadline() const;

  // A new session with the server: nothing of the one before counts.
  void begin_session();
  // For a guest whom nobody has heard in this slot: what was encoded before is no reference.
  void begin_encoder(LocalGuest& guest);

  // What the server says about our records,
  void on_acks(const wire::Acks& acks);
  void on_feedback(std::uint16_t number, const wire::Feedback& feedback, MonoTime now);
  // and when we tell it of its own.
  MonoTime when_to_acknowledge(MonoTime now) const;

  // A capture's time as the wire tells it; false for one of no time under way.
  struct Stamp {
    MonoTime capture;  // in our clock
    std::int64_t capture_us;
    std::int32_t published_age_us;
    std::int32_t sent_age_us;
  };
  bool stamp(MonoTime capture, std::uint64_t clock_id, MonoTime published, MonoTime now,
             Stamp& out);

 private:
  void settle_quality(LocalGuest& guest, MonoTime now);
  void put(const wire::Record& record, MonoTime now);
  void flush(MonoTime now);
  void send_datagram(bool with_records, MonoTime now);

  LinkContext& link_;
  bool wants_repeats_ = false;  // the server, of our poses
  bool has_feedback_ = false;
  std::uint16_t newest_feedback_ = 0;  // number of its datagram
};

}  // namespace dance
