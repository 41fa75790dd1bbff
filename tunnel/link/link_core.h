// A house's link as a state machine: poses of this house in, datagrams to the server out; datagrams
// of the server in, poses of the others out, in this house's clock. Finds the server again by
// itself whatever happens to either side. What seals its datagrams tells it when there is a sealed
// session; without one it says nothing.
//
// Units/frames: now and received are MonoTime of this house's clock.
// Ownership:    owns codecs and tables; the sink must outlive it. Sending and receiving poses never
//               allocates once a guest is known.
// Threads:      none inside; one owner.
// Failure:      what cannot be sent or does not decode is dropped and counted, never queued.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/random.h"
#include "core/bus/messages.h"
#include "core/net/clock_mapper.h"
#include "core/net/datagram_sink.h"
#include "tunnel/link/link_guests.h"
#include "tunnel/link/link_options.h"
#include "tunnel/session/interest_filter.h"
#include "tunnel/session/stream.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

class LinkCore {
 public:
  LinkCore(const LinkOptions& options, LinkHandlers handlers, DatagramSink& sink);

  // A sealed session has begun, or begun anew: says hello at once.
  void on_sealed(MonoTime now);
  // The sealed session is gone: nothing is sent until the next one.
  void on_unsealed(MonoTime now);
  // Datagrams go out from another address from now on: says so at once.
  void on_moved(MonoTime now);
  void receive(wire::Bytes datagram, MonoTime received, MonoTime now);
  // Does what is due and returns when to call again; MonoTime() = not before it is sealed.
  MonoTime tick(MonoTime now);
  // When tick() is due: earlier than it said, after a guest was added or the server began anew.
  MonoTime next_deadline() const;

  void send(const GuestId& guest, const Pose& pose, MonoTime now);
  void send(const GuestId& guest, const Hands& hands, MonoTime now);
  void send(const GuestId& guest, const Skeleton& skeleton, MonoTime now);
  // States of a guest of this house: told until the server has them.
  void send(const GuestId& guest, const Avatar& avatar, MonoTime now);
  void send(const GuestId& guest, const Style& style, MonoTime now);
  void send(const GuestId& guest, const Placement& placement, MonoTime now);
  // Wishes of a guest of this house for the room: what holds comes through the handlers.
  void send(const GuestId& guest, const Music& music, MonoTime now);
  void send(const GuestId& guest, const Scene& scene, MonoTime now);
  // A message of a further channel, where a rule of the options lets it out.
  void send_channel(std::string_view name, wire::Bytes message, MonoTime now);
  // Whom the server is to send, and how often: told until it is acknowledged. For guests who are
  // not here, it counts when they come.
  void set_interest(const Interest& interest, MonoTime now);
  void say_goodbye();

  LinkState state() const { return state_; }
  bool is_connected() const { return state_ == LinkState::kConnected; }
  // Hellos since the last sign of the server, those that come quickly not counted: many, and
  // another socket may be worth a try.
  int unanswered_hellos() const { return unanswered_hellos_; }
  const LinkCounters& counters() const { return counters_; }
  const ClockMapper& clock() const { return clock_; }
  // The room's music in this house's clock, as it is mapped now.
  std::optional<Music> room_music(MonoTime now) const;
  const GuestId& room_music_setter() const { return held_[0].setter; }
  void fill(Stats& stats) const;
  // Those who are here, and the last that have left.
  std::vector<RemoteGuestStats> remote_stats() const;
  std::vector<LocalGuestStats> local_stats() const;
  const PathStats& path() const { return path_; }

 private:
  void deliver_state(LinkState state, MonoTime now);
  void send_datagram(wire::Bytes bytes);
  LocalGuest& add_local(const GuestId& id);
  LocalGuest* find_or_add(const GuestId& id, MonoTime now);
  bool is_ours(const wire::RosterEntry& entry) const;

  // link_session.cpp
  void send_hello(MonoTime now);
  Duration ping_period(MonoTime now) const;
  void send_ping(MonoTime now);
  void begin_lapse(MonoTime now);
  void leave_out(const GuestId& refused, MonoTime now);
  void let_silent_go(MonoTime now);
  void schedule_update(MonoTime now);
  void heard_server(MonoTime now);
  void on_welcome(wire::Bytes body, MonoTime received, MonoTime now);
  void on_refusal(wire::Bytes body, MonoTime now);
  bool on_session_datagram(const wire::Opening& opening, MonoTime received, MonoTime now);
  bool on_pong(wire::Bytes body, MonoTime received);

  // link_receive.cpp
  bool on_records(wire::Bytes body, MonoTime received, MonoTime now);
  // False for a pose that did not decode.
  bool on_record(wire::Record record, MonoTime received, MonoTime now);
  void on_hands(const wire::Record& record, const GuestId& id, MonoTime capture, MonoTime now);
  bool decode(RemoteGuest& remote, const wire::Record& record, MonoTime now);
  void renew_decoder(RemoteGuest& remote);
  bool on_roster(wire::Bytes body, MonoTime now);
  void settle_slot(RemoteGuest& remote, const wire::RosterEntry* entry);
  void keep_counts(const RemoteGuest& remote);
  bool is_present(const GuestId& id) const;

  // link_states.cpp
  LocalGuest* find_local(const GuestId& id);
  void tell(const GuestId& id, wire::StateKind kind, wire::Bytes payload, MonoTime now);
  template <class Message>
  void tell_message(const GuestId& id, wire::StateKind kind, const Message& message, MonoTime now);
  void send_state(const wire::State& state);
  void repeat_states(MonoTime now);
  void forget_room();
  bool is_due(const ReplicatedState& state, const wire::StateName& name,
              const wire::Slot& slot) const {
    return state.version != 0 && !stream_.states.has(name, slot.slot, state.version);
  }
  bool on_states(wire::Bytes body, MonoTime now);
  bool on_guest_state(const wire::State& state, MonoTime now);
  bool deliver_guest_state(RemoteGuest& remote, const wire::State& state, MonoTime now);
  template <class Message, class Handler>
  bool deliver_message(const GuestId& id, wire::Bytes payload, const Handler& handler,
                       MonoTime now);
  bool on_state_acks(wire::Bytes body);

  // link_wishes.cpp
  void make_wish(const GuestId& setter, wire::StateKind kind, wire::Bytes payload, MonoTime now);
  void map_wished_music();
  bool on_room_state(const wire::State& state, MonoTime now);
  void give_way(std::size_t place, const GuestId& setter, std::uint32_t version);
  void on_wish_ack(const wire::StateAck& ack);

  // link_channels.cpp
  void announce_streams();
  static void set_payload(HouseChannel& channel, wire::Bytes message);
  HouseChannel* find_or_add_channel(std::string_view name, const ChannelRule& rule);
  bool bind_channel(HouseChannel& channel);
  bool is_channel_due(HouseChannel& channel, MonoTime now);
  void send_channel_record(HouseChannel& channel, wire::Bytes message, MonoTime now);
  bool on_channel_state(RemoteGuest& remote, const wire::State& state, MonoTime now);
  void on_channel_record(const wire::Record& record, MonoTime now);
  void deliver_channel(RemoteGuest& remote, const RemoteChannel& channel, wire::Bytes message,
                       MonoTime now);

  // link_send.cpp
  struct Stamp {
    MonoTime capture;  // in our clock
    std::int64_t capture_us;
    std::int32_t published_age_us;
    std::int32_t sent_age_us;
  };
  bool stamp(MonoTime capture, std::uint64_t clock_id, MonoTime published, MonoTime now,
             Stamp& out);
  void add_record(const wire::Record& record, MonoTime now);
  void repeat_before(LocalGuest& guest, const wire::Record& next, MonoTime now);
  void put(const wire::Record& record, MonoTime now);
  bool may_send(MonoTime now) const;
  bool is_narrow(const wire::Record& record) const;
  void flush_records(MonoTime now);
  void send_records_datagram(bool with_bundle, MonoTime now);
  std::size_t count_dancing(MonoTime now) const;

  // link_interest.cpp
  void settle_interest();
  void tell_interest();
  bool on_interest_ack(wire::Bytes body);

  // link_feedback.cpp
  void begin_session_records();
  void settle_encoder(LocalGuest& guest);
  MonoTime when_to_acknowledge(MonoTime now) const;
  bool is_way_clean() const;
  void want_key_frame(RemoteGuest& remote, MonoTime now);
  void on_acks(const wire::Acks& acks);
  void on_feedback(std::uint16_t number, const wire::Feedback& feedback, MonoTime now);

  LinkOptions options_;
  LinkHandlers handlers_;
  DatagramSink& sink_;
  Random random_;
  LinkState state_ = LinkState::kConnecting;
  bool is_sealed_ = false;
  // A welcome has come through the sealed session of now: only then the server knows who speaks.
  bool is_welcome_ = false;
  std::uint64_t epoch_ = 0;
  CodecName codec_;
  ClockMapper clock_;
  LinkCounters counters_;

  // Hello under way.
  bool removal_untold_ = false;  // the server still has a guest of ours who has left
  bool hello_wanted_ = true;
  std::uint64_t hello_nonce_ = 0;
  FixedList<std::uint8_t, wire::kMaxGuestsPerLink> hello_guests_;  // places in locals_
  MonoTime next_hello_;
  Duration hello_wait_;
  int unanswered_hellos_ = 0;
  int hellos_in_lapse_ = 0;

  MonoTime last_heard_;
  MonoTime next_ping_;
  MonoTime heard_records_;
  std::uint32_t ping_sequence_ = 0;
  int quick_pings_left_ = 0;

  std::vector<LocalGuest> locals_;    // reserved; at most kMaxGuestsPerLink
  std::vector<RemoteGuest> remotes_;  // by slot
  // Counts of those who left or got another slot, so that a summary at the end has everybody.
  std::vector<RemoteGuestStats> departed_;  // reserved; the oldest makes room
  RosterAssembly roster_;
  InterestRequest interest_;
  Stream stream_;
  bool wants_repeats_ = false;  // the server, of our poses
  bool has_feedback_ = false;
  std::uint16_t newest_feedback_ = 0;  // number of its datagram
  PathStats path_;
  // What changes seldom.
  TokenBucket state_changes_{10.0, 20.0};  // told at once; more goes with the pings
  std::array<RoomWish, wire::kRoomStates> wishes_;
  std::array<RoomHeld, wire::kRoomStates> held_;
  Music wished_music_;  // in our clock
  Music held_music_;    // in the server's
  bool has_held_music_ = false;
  std::vector<HouseChannel> channels_;  // reserved; at most kMaxHouseChannels
  Pose decoded_;
  Hands decoded_hands_;
};

}  // namespace dance
