// The room's music, song and scene: the requests of this house's guests, sent until the server has
// them or newer ones of other guests; and the state in force.
//
// Units/frames: times of music and song in the server's clock, unless a name says otherwise.
// Ownership:    refers to the link's context.
// Threads:      none inside; one owner.
// Failure:      what is impossible, or of a guest who is not here, is counted and dropped.
#pragma once

#include <array>
#include <optional>

#include "tunnel/link/core/link_context.h"

namespace dance {

class LinkRoom {
 public:
  explicit LinkRoom(LinkContext& link) : link_(link) {}

  void send(const GuestId& id, const Music& music, MonoTime now);
  void send(const GuestId& id, const RoomSong& song, MonoTime now);
  void send(const GuestId& id, const Scene& scene, MonoTime now);
  bool on_state(const wire::State& state, MonoTime now);
  void on_ack(const wire::StateAck& ack);
  // Call for a new session: its room's state is not known yet.
  void begin_session();
  // Call when the clocks are mapped: a server that restarted has another clock.
  void map_times();
  // Requests that the server has not acknowledged, each handed to `add`.
  template <class Add>
  void each_due(Add add) const {
    for (std::size_t place = 0; place < wire::kRoomStates; ++place) {
      const Request& request = requests_[place];
      const LocalGuest* guest = request.is_open ? link_.locals.find(request.setter) : nullptr;
      const wire::StateName name = wire::room_state_at(place);
      if (guest != nullptr && guest->has_slot && !request.is_refused &&
          link_.is_due(request.state, name, {}))
        add(wire::State{name, {}, request.setter, request.state.version, request.state.bytes()});
    }
  }

  // The state in force, in this house's clock as it is mapped now.
  std::optional<Music> music(MonoTime now) const { return in_our_clock(music_, now); }
  std::optional<RoomSong> song(MonoTime now) const { return in_our_clock(song_, now); }
  const GuestId& setter(wire::StateKind kind) const {
    return current_[wire::place_of({kind, 0})].setter;
  }

 private:
  // The request of a guest of this house, until another guest has set the state.
  struct Request {
    GuestId setter;
    bool is_open = false;
    // Made before the room's was known: its version may have to be raised, once.
    bool is_blind = false;
    bool is_refused = false;  // until it changes
    ReplicatedState state;
  };
  struct Current {
    GuestId setter;
    std::uint32_t version = 0;  // of this session; 0 = not received yet
  };

  // A state with a start time.
  template <class Message>
  struct Timed {
    Message requested;  // in our clock
    Message current;    // in the server's
    bool is_known = false;
  };

  template <class Message>
  void send_timed(const GuestId& id, const Message& given, Timed<Message>& timed, MonoTime now);
  template <class Message>
  void map_time(const Timed<Message>& timed);
  template <class Message, class Handler>
  bool deliver_timed(const wire::State& state, Timed<Message>& timed, const Handler& handler,
                     MonoTime now);
  template <class Message>
  std::optional<Message> in_our_clock(const Timed<Message>& timed, MonoTime now) const {
    if (!timed.is_known) return std::nullopt;
    Message message = timed.current;
    message.time = now;
    message.clock_id = link_.options.clock_id;
    message.start_time = link_.clock.to_ours(timed.current.start_time.since_zero_us());
    return message;
  }
  void make_request(const GuestId& setter, wire::StateKind kind, wire::Bytes payload, MonoTime now);
  void yield_to(std::size_t place, const GuestId& setter, std::uint32_t version);

  LinkContext& link_;
  std::array<Request, wire::kRoomStates> requests_;
  std::array<Current, wire::kRoomStates> current_;
  Timed<Music> music_;
  Timed<RoomSong> song_;
};

}  // namespace dance
