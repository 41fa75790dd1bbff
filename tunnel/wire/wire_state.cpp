#include "tunnel/wire/wire_state.h"

#include "core/base/assert.h"

namespace dance::wire {
namespace {

constexpr std::array<StateKind, kFirstChannelPlace> kGuestKinds{
    StateKind::kSkeleton,  StateKind::kAvatar,     StateKind::kStyle,
    StateKind::kPlacement, StateKind::kAvatarFile, StateKind::kChat};
constexpr std::array<StateKind, kRoomStates> kRoomKinds{StateKind::kMusic, StateKind::kScene,
                                                        StateKind::kSong};
constexpr int kIndexShift = 4;

void write_state_name(const StateName& name, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(static_cast<unsigned>(name.kind) |
                                   static_cast<unsigned>(name.index) << kIndexShift));
}

std::optional<StateName> read_state_name(ByteReader& in) {
  const std::uint8_t byte = in.u8();
  StateName name{static_cast<StateKind>(byte & 15), static_cast<std::uint8_t>(byte >> kIndexShift)};
  const bool is_known = name.kind >= StateKind::kSkeleton && name.kind <= StateKind::kChat;
  const std::size_t most = name.kind == StateKind::kChannel ? kMaxChannelsPerGuest : 1;
  if (!in.ok() || !is_known || name.index >= most) return std::nullopt;
  return name;
}

void write_state_slot(const Slot& slot, ByteWriter& out) {
  out.u8(slot.slot);
  out.u16(slot.generation);
}

Slot read_state_slot(ByteReader& in) {
  Slot slot;
  slot.slot = in.u8();
  slot.generation = in.u16();
  return slot;
}

}  // namespace

std::size_t place_of(const StateName& name) {
  if (name.kind == StateKind::kChannel) return kFirstChannelPlace + name.index;
  if (name.kind == StateKind::kMusic) return 0;
  if (name.kind == StateKind::kScene) return 1;
  if (name.kind == StateKind::kSong) return 2;
  for (std::size_t place = 0; place < kGuestKinds.size(); ++place)
    if (kGuestKinds[place] == name.kind) return place;
  DANCE_ASSERT(false, static_cast<int>(name.kind));
  return 0;
}

StateName guest_state_at(std::size_t place) {
  if (place < kFirstChannelPlace) return {kGuestKinds[place], 0};
  return {StateKind::kChannel, static_cast<std::uint8_t>(place - kFirstChannelPlace)};
}

StateName room_state_at(std::size_t place) { return {kRoomKinds[place], 0}; }

std::size_t size_of(const State& state) {
  return 1 + 1 + kMaxGuestIdLength + 4 + 2 + state.payload.size();
}

void begin_states(Type type, ByteWriter& out) { out.u8(static_cast<std::uint8_t>(type)); }

void add_state(const State& state, ByteWriter& out) {
  write_state_name(state.name, out);
  if (is_of_room(state.name.kind))
    out.short_text(state.setter.view());
  else
    write_state_slot(state.slot, out);
  out.u32(state.version);
  out.u16(static_cast<std::uint16_t>(state.payload.size()));
  out.bytes(state.payload);
}

std::optional<State> parse_state(ByteReader& in) {
  const auto name = read_state_name(in);
  if (!name) return std::nullopt;
  State state;
  state.name = *name;
  if (is_of_room(name->kind)) {
    const std::size_t length = in.u8();
    const auto setter = GuestId::parse(in.text(length));
    if (!setter) return std::nullopt;
    state.setter = *setter;
  } else {
    state.slot = read_state_slot(in);
  }
  state.version = in.u32();
  const std::size_t length = in.u16();
  state.payload = in.bytes(length);
  if (!in.ok() || state.version == 0 || state.slot.slot >= kMaxGuestsPerRoom || length == 0 ||
      length > kMaxStatePayload)
    return std::nullopt;
  return state;
}

void add_state_ack(const StateAck& ack, ByteWriter& out) {
  write_state_name(ack.name, out);
  if (!is_of_room(ack.name.kind)) write_state_slot(ack.slot, out);
  out.u32(ack.version);
  out.u8(static_cast<std::uint8_t>(ack.verdict));
}

std::optional<StateAck> parse_state_ack(ByteReader& in) {
  const auto name = read_state_name(in);
  if (!name) return std::nullopt;
  StateAck ack;
  ack.name = *name;
  if (!is_of_room(name->kind)) ack.slot = read_state_slot(in);
  ack.version = in.u32();
  const std::uint8_t verdict = in.u8();
  ack.verdict = static_cast<StateVerdict>(verdict);
  if (!in.ok() || ack.version == 0 || ack.slot.slot >= kMaxGuestsPerRoom ||
      verdict > static_cast<std::uint8_t>(StateVerdict::kNotAllowed))
    return std::nullopt;
  return ack;
}

std::size_t build(const ChannelPayload& channel, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  out.u8(static_cast<std::uint8_t>(channel.kind));
  out.short_text(channel.name.view());
  out.bytes(channel.message);
  return out.ok() ? out.size() : 0;
}

std::optional<ChannelPayload> parse_channel(Bytes payload) {
  ByteReader in(payload);
  ChannelPayload channel;
  channel.kind = static_cast<ChannelClass>(in.u8());
  const std::size_t length = in.u8();
  const std::string_view name = in.text(length);
  if (!in.ok() || !is_foreign_name(name) || !channel.name.assign(name)) return std::nullopt;
  channel.message = in.bytes(in.remaining());
  const bool is_state = channel.kind == ChannelClass::kState;
  if (!is_state && channel.kind != ChannelClass::kNewest) return std::nullopt;
  if (is_state ? channel.message.size() > kMaxChannelStateBytes : !channel.message.empty())
    return std::nullopt;
  return channel;
}

}  // namespace dance::wire
