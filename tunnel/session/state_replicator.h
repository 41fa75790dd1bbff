// States: of each the newest version is repeated until the other side has it. What link and server
// share of that: a version's bytes, what the other side has acknowledged, and the datagrams.
//
// Units/frames: versions are 32 bit, wrap and are never 0; as in tunnel/wire/wire_state.h.
// Ownership:    plain values of fixed size; never allocates.
// Threads:      none inside.
// Failure:      a malformed datagram is false as a whole, and nothing of it is taken.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/assert.h"
#include "core/base/sequence.h"
#include "tunnel/wire/wire_state.h"

namespace dance {

constexpr std::uint32_t next_version(std::uint32_t version) {
  return version + 1 == 0 ? 1 : version + 1;
}

// The newest version of one state.
struct ReplicatedState {
  std::uint32_t version = 0;  // 0 = none yet
  std::uint16_t size = 0;
  std::array<std::uint8_t, wire::kMaxStatePayload> payload;

  wire::Bytes bytes() const { return {payload.data(), size}; }
  bool is_newer(std::uint32_t other) const {
    return version == 0 || is_newer_sequence(other, version);
  }
  void set(std::uint32_t new_version, wire::Bytes bytes);
  // A change of our own: the next version. False where it is what it was.
  bool change(wire::Bytes bytes);
};

// What the other side of a session has of the states that it is told.
class StateReplicator {
 public:
  // `slot` is the guest's; of a state of the room it does not matter.
  bool has(const wire::StateName& name, std::uint8_t slot, std::uint32_t version) const {
    return acked(name, slot) == version;
  }
  void take(const wire::StateAck& ack) { acked(ack.name, ack.slot.slot) = ack.version; }
  // Another guest has the slot, or another state that place.
  void forget(std::uint8_t slot) { of_guests_[slot] = {}; }
  void forget(const wire::StateName& name, std::uint8_t slot) { acked(name, slot) = 0; }

 private:
  const std::uint32_t& acked(const wire::StateName& name, std::uint8_t slot) const {
    const std::size_t place = wire::place_of(name);
    return wire::is_of_room(name.kind) ? of_room_[place] : of_guests_[slot][place];
  }
  std::uint32_t& acked(const wire::StateName& name, std::uint8_t slot) {
    return const_cast<std::uint32_t&>(std::as_const(*this).acked(name, slot));
  }

  std::array<std::array<std::uint32_t, wire::kGuestStates>, wire::kMaxGuestsPerRoom> of_guests_{};
  std::array<std::uint32_t, wire::kRoomStates> of_room_{};
};

// Packs states into datagrams, up to so many; `send` takes each one's bytes.
template <class Send>
class StateWriter {
 public:
  explicit StateWriter(Send send, std::size_t most_datagrams = SIZE_MAX)
      : send_(std::move(send)), left_(most_datagrams) {}
  ~StateWriter() { flush(); }
  StateWriter(const StateWriter&) = delete;
  StateWriter& operator=(const StateWriter&) = delete;

  // False where there is no room for it any more.
  bool add(const wire::State& state) {
    if (out_.room() < wire::size_of(state)) flush();
    if (left_ == 0) return false;
    if (out_.size() == 0) wire::begin_states(wire::Type::kState, out_);
    wire::add_state(state, out_);
    DANCE_ASSERT(out_.ok());
    return true;
  }

 private:
  void flush() {
    if (out_.size() == 0) return;
    send_(out_.written());
    out_ = ByteWriter(bytes_);
    --left_;
  }

  Send send_;
  std::size_t left_;
  std::array<std::uint8_t, wire::kMaxPlain> bytes_;
  ByteWriter out_{bytes_};
};

// Hands each state of a datagram to `take`, which gives its acknowledgement or nothing; `send`
// takes the answer, if there is one. A state takes more bytes than its acknowledgement.
template <class Take, class Send>
bool answer_states(wire::Bytes body, Take take, Send send) {
  ByteReader check(body);
  do {
    if (!wire::parse_state(check)) return false;
  } while (check.remaining() > 0);
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  ByteWriter out(bytes);
  wire::begin_states(wire::Type::kStateAck, out);
  const std::size_t opening = out.size();
  for (ByteReader in(body); in.remaining() > 0;) {
    const std::optional<wire::StateAck> ack = take(*wire::parse_state(in));
    if (ack) wire::add_state_ack(*ack, out);
  }
  DANCE_ASSERT(out.ok());
  if (out.size() > opening) send(out.written());
  return true;
}

template <class Take>
bool take_state_acks(wire::Bytes body, Take take) {
  ByteReader check(body);
  do {
    if (!wire::parse_state_ack(check)) return false;
  } while (check.remaining() > 0);
  for (ByteReader in(body); in.remaining() > 0;) take(*wire::parse_state_ack(in));
  return true;
}

}  // namespace dance
