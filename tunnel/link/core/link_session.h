// How a link comes to its session, keeps it, and gets it back: hellos until a welcome comes, pings
// while it stands, and hellos again when the server falls silent.
//
// Units/frames: now and received are MonoTime of this house's clock.
// Ownership:    refers to the link's context.
// Threads:      none inside; one owner.
// Failure:      answers to nothing that was asked are rejected; a refusal is handed on, and asked
//               about again.
#pragma once

#include <optional>

#include "core/base/random.h"
#include "tunnel/link/core/link_context.h"

namespace dance {

class LinkSession {
 public:
  explicit LinkSession(LinkContext& link) : link_(link), random_(link.options.seed) {}

  // As LinkCore's of the same name.
  void on_sealed(MonoTime now);
  void on_unsealed(MonoTime now);
  void on_moved(MonoTime now);
  void on_goodbye(MonoTime now);
  void send_goodbye();

  MonoTime next_deadline() const;
  // Evicts guests who fell silent, notices a server that did, asks again for who was refused.
  void update(MonoTime now);
  void send_due_hello(MonoTime now);
  // The hello of now does not name the guests as they are: another one does.
  void schedule_update(MonoTime now);

  // The answer to the hello; nothing where it is none.
  std::optional<wire::Welcome> parse_answer(wire::Bytes body) const;
  bool is_new(const wire::Welcome& welcome) const { return welcome.epoch != epoch_; }
  // Gives our guests their slots; `begin` is called for each that needs a new encoder.
  template <class Begin>
  void settle_guests(const wire::Welcome& welcome, Begin begin);
  void begin(const wire::Welcome& welcome, MonoTime now);
  bool on_refusal(wire::Bytes body, MonoTime now);

  bool is_ping_due(MonoTime now) const { return now >= next_ping_; }
  void send_ping(std::uint32_t roster_version, bool is_calm, MonoTime now);
  bool on_pong(wire::Bytes body, MonoTime received);
  void heard_server(MonoTime now);

  // A welcome has come through the sealed session of now: only then the server knows who speaks.
  bool is_welcome() const { return is_welcome_; }
  bool may_send(MonoTime now) const;
  int unanswered_hellos() const { return unanswered_hellos_; }
  // A host has removed this house's guests: until then nothing is asked. Not set, or past: it is.
  MonoTime removed_until() const { return removed_until_; }
  // The server ends, or has forgotten this session: said since the last welcome.
  bool has_goodbye() const { return has_goodbye_; }

 private:
  void set_state(LinkState state, MonoTime now);
  void send_hello(MonoTime now);
  void begin_lapse(MonoTime now);
  void ask_from(MonoTime when) { next_hello_ = std::max(when, removed_until_); }
  void stay_away(Duration for_how_long, MonoTime now);
  void leave_out(const GuestId& refused, MonoTime now);

  LinkContext& link_;
  Random random_;
  bool is_sealed_ = false;
  bool is_welcome_ = false;
  bool has_goodbye_ = false;
  std::uint64_t epoch_ = 0;

  // Hello under way.
  bool has_untold_removal_ = false;  // the server still has a guest of ours who has left
  bool hello_wanted_ = true;
  std::uint64_t hello_nonce_ = 0;
  FixedList<std::uint8_t, wire::kMaxGuestsPerLink> hello_guests_;  // places in locals
  MonoTime next_hello_;
  MonoTime removed_until_;
  Duration hello_wait_;
  int unanswered_hellos_ = 0;
  int hellos_in_lapse_ = 0;

  MonoTime last_heard_;
  MonoTime next_ping_;
  std::uint32_t ping_sequence_ = 0;
  int quick_pings_left_ = 0;
};

// By slot and generation: a guest of an earlier session, or in another slot, is heard anew.
template <class Begin>
void LinkSession::settle_guests(const wire::Welcome& welcome, Begin begin) {
  for (LocalGuest& guest : link_.locals) guest.has_slot = false;
  for (std::size_t i = 0; i < hello_guests_.size(); ++i) {
    LocalGuest& guest = link_.locals[hello_guests_[i]];
    const wire::Slot& slot = welcome.slots[i];
    const bool is_same = !is_new(welcome) && guest.slot == slot;
    if (!is_same) link_.stream.states.forget(slot.slot);
    guest.has_slot = true;
    guest.slot = slot;
    if (!guest.encoder || guest.encoder->name() != link_.codec || !is_same) begin(guest);
  }
}

}  // namespace dance
