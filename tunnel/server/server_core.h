// The tunnel's server as a state machine: datagrams in, datagrams out. Forwards each guest's newest
// pose to everybody else in the room without looking into it; keeps who is in which room and the
// newest states (bodies, music, further channels) for those who come later.
//
// Speaks with peers that have proved who they are: whoever calls receive() has checked their keys.
//
// Units/frames: now and received are MonoTime of the server's clock, which is the tunnel's clock.
// Ownership:    owns sessions and rooms, all made at construction; the sink must outlive it. Taking
//               and forwarding records never allocates.
// Threads:      none inside; one owner.
// Failure:      whatever a datagram does not do right is counted by cause; nothing from outside can
//               make it stop or grow.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "tunnel/server/access.h"
#include "tunnel/server/server_state.h"
#include "tunnel/session/peer.h"

namespace dance {

class ServerCore {
 public:
  using RandomU64 = std::function<std::uint64_t()>;

  ServerCore(const ServerLimits& limits, RandomU64 random, PeerSink& sink);

  // One datagram that came in at `received`, and what the sender's key lets it do.
  void receive(PeerId from, const Access& access, wire::Bytes datagram, MonoTime received,
               MonoTime now);
  // The sealed session has ended: so has what it had here.
  void forget(PeerId peer);
  // Sends what the datagrams of this turn left to send. Call after the last of them.
  void end_turn(MonoTime now);
  // Drops sessions that fell silent, sends what has waited; returns when to call again, MonoTime()
  // = not before a datagram.
  MonoTime tick(MonoTime now);
  // When tick() is due, which may be earlier after a turn.
  MonoTime next_deadline() const;
  // Tells everybody that the server ends.
  void say_goodbye();

  // Names of those who have a key of their own: a key for all does not open them.
  void set_reserved(std::function<bool(const GuestId&)> is_reserved) {
    is_reserved_ = std::move(is_reserved);
  }

  const ServerCounters& counters() const { return counters_; }
  std::size_t session_count() const { return by_peer_.size(); }
  std::size_t room_count() const;
  std::size_t guest_count() const;
  std::size_t listener_count() const;
  // For the status line and tests.
  const std::vector<ServerSession>& sessions() const { return sessions_; }
  const std::vector<ServerRoom>& rooms() const { return rooms_; }

 private:
  void reject(ServerReject cause) { ++counters_.rejected[static_cast<std::size_t>(cause)]; }
  void send(PeerId to, wire::Bytes bytes);

  // server_hello.cpp
  void on_hello(PeerId from, const Access& access, wire::Bytes body, MonoTime received,
                MonoTime now);
  void welcome(std::size_t session, const wire::Hello& hello, MonoTime received, MonoTime now);
  void refuse(PeerId to, std::uint64_t nonce, wire::Refusal cause, const GuestId& guest);
  std::optional<std::size_t> find_token(std::uint64_t token, const GuestId& key) const;
  std::optional<std::size_t> find_room(const wire::RoomName& name) const;
  struct Objection {
    wire::Refusal cause;
    GuestId guest;
  };
  std::optional<Objection> objection_to(const wire::Hello& hello, const Access& access,
                                        std::optional<std::size_t> existing,
                                        std::optional<std::size_t> room) const;
  std::size_t open_room(const wire::Hello& hello);
  std::size_t open_session(PeerId peer, const Access& access, const wire::Hello& hello,
                           std::size_t room);
  std::uint64_t new_epoch();
  void move_session(std::size_t session, PeerId to);
  void settle_access(std::size_t session, const Access& access);
  void settle_guests(std::size_t session, const wire::Hello& hello);
  void add_guest(std::size_t session, const GuestId& id);
  void remove_guest(std::size_t room, std::uint8_t slot);
  void drop_session(std::size_t session);

  // server_core.cpp
  void stir(ServerRoom& room);
  void send_away(PeerId peer);
  void on_session_datagram(std::size_t session, const wire::Opening& opening, MonoTime received,
                           MonoTime now);
  void on_ping(std::size_t session, wire::Bytes body, MonoTime received, MonoTime now);
  void send_roster(const ServerSession& session);
  ServerGuest* guest_of(std::size_t session, std::uint8_t slot);
  bool is_newcomer(std::size_t session) const;
  void flush_due(MonoTime now);
  void sweep(MonoTime now);

  // server_states.cpp
  void on_states(std::size_t session, wire::Bytes body, MonoTime now);
  std::optional<wire::StateAck> take_state(std::size_t session, const wire::State& state,
                                           MonoTime now);
  std::optional<wire::StateAck> take_room_state(std::size_t session, const wire::State& state,
                                                MonoTime now);
  void hold_state(ServerRoom& room, RetainedState& held, const wire::State& state);
  void on_state_acks(std::size_t session, wire::Bytes body);
  // All that the link has not acknowledged, or of that only what nobody has been told yet.
  void send_states(std::size_t session, bool only_fresh, std::size_t most_datagrams);
  void send_fresh_states(ServerRoom& room, MonoTime now);

  // server_kept.cpp
  void keep(ServerGuest& guest, const wire::Record& record);
  void greet(std::size_t newcomer, MonoTime now);
  void send_kept(std::size_t to, std::uint8_t slot, MonoTime now);
  void repeat_kept(std::size_t to, MonoTime now);

  // server_records.cpp
  void on_records(std::size_t session, wire::Bytes body, MonoTime received, MonoTime now);
  void on_channel_record(std::size_t session, wire::Record record, MonoTime now);
  void on_record(std::size_t session, wire::Record record, MonoTime received, MonoTime now);
  void forward(std::size_t from, const wire::Record& record, MonoTime now);
  void add_to_bundle(std::size_t to, const wire::Record& record, MonoTime now);
  void put_in_bundle(std::size_t session, const wire::Record& record, MonoTime now);
  void repeat_before(std::size_t member, const ServerGuest& guest, const wire::Record& next,
                     MonoTime now);
  Duration share_window(const ServerRoom& room) const;
  bool is_bundle_due(const ServerSession& session, MonoTime now) const;
  void flush_bundle(std::size_t session, MonoTime now);
  void send_records(std::size_t session, MonoTime now);

  // server_interest.cpp
  void on_interest(std::size_t session, wire::Bytes body, MonoTime now);
  void settle_interest(std::size_t session, MonoTime now);
  void set_divider(std::size_t session, std::uint8_t slot, std::uint8_t divider, MonoTime now);
  bool wants_any_of(const ServerSession& receiver, const ServerSession& sender) const;
  // Whether a record goes to a receiver; counts those that do not.
  bool take_share(std::size_t to, const wire::Record& record, MonoTime now);

  // server_feedback.cpp
  void on_acks(std::size_t session, const wire::Acks& acks, MonoTime now);
  void on_want(std::size_t session, std::uint8_t slot, MonoTime now);
  void want_key_frames_for(std::size_t newcomer, MonoTime now);
  void want_key_frame(ServerGuest& guest, MonoTime now);
  void repeat_feedback(std::size_t session, MonoTime now);
  void schedule_feedback(std::size_t session, MonoTime now);
  void schedule_feedback(std::size_t session, MonoTime at, Duration waits, Duration gap);
  bool is_receiver(std::size_t member, std::size_t sender, MonoTime now) const;
  wire::GuestFeedback feedback_about(std::size_t session, std::uint8_t slot, MonoTime now) const;
  // False where there is nothing new to tell.
  bool fill_feedback(std::size_t session, MonoTime now, wire::Feedback& feedback);

  ServerLimits limits_;
  RandomU64 random_;
  std::function<bool(const GuestId&)> is_reserved_;
  std::array<TokenBucket, 256> hellos_;  // by key: names that fall on one place share it
  PeerSink& sink_;
  std::vector<ServerSession> sessions_;
  std::vector<ServerRoom> rooms_;
  std::unordered_map<PeerId, std::size_t> by_peer_;
  std::vector<std::size_t> newcomers_;  // sessions that know nothing of their room yet
  std::vector<std::size_t> bundled_;    // sessions with a bundle under way
  std::vector<std::size_t> reporting_;  // sessions with feedback due
  std::vector<std::size_t> astir_;      // rooms with a roster or states to tell
  MonoTime next_sweep_;
  ServerCounters counters_;
};

}  // namespace dance
