#include "tunnel/wire/wire.h"

#include "tunnel/wire/wire_removal.h"

namespace dance::wire {
namespace {

void write_opening(Type type, ByteWriter& out) { out.u8(static_cast<std::uint8_t>(type)); }

std::size_t size_of(const ByteWriter& out) { return out.ok() ? out.size() : 0; }

std::optional<GuestId> read_name(ByteReader& in) {
  const std::size_t length = in.u8();
  return GuestId::parse(in.text(length));
}

void write_slot(const Slot& slot, ByteWriter& out) {
  out.u8(slot.slot);
  out.u16(slot.generation);
}

Slot read_slot(ByteReader& in) {
  Slot slot;
  slot.slot = in.u8();
  slot.generation = in.u16();
  return slot;
}

void write_codec(const CodecName& codec, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(codec.id));
  out.u32(codec.model);
}

CodecName read_codec(ByteReader& in) {
  CodecName codec;
  codec.id = static_cast<CodecId>(in.u8());
  codec.model = in.u32();
  return codec;
}

}  // namespace

std::optional<Opening> parse_opening(Bytes datagram) {
  ByteReader in(datagram);
  Opening opening;
  const std::uint8_t first = in.u8();
  if (!in.ok()) return std::nullopt;
  // The commonest by far: its flags are in the same byte.
  if ((first & kRecordsMark) != 0) return Opening{Type::kRecords, datagram};
  if (first == static_cast<std::uint8_t>(Type::kRecords)) return std::nullopt;
  opening.type = static_cast<Type>(first);
  opening.body = datagram.subspan(kSessionHeader);
  return opening;
}

std::size_t build(const Hello& hello, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kHello, out);
  out.u8(hello.version);
  out.u64(hello.nonce);
  out.u64(hello.token);
  out.i64(hello.link_time_us);
  out.u8(static_cast<std::uint8_t>(hello.codecs.size()));
  for (const CodecName& codec : hello.codecs) write_codec(codec, out);
  out.short_text(hello.room.view());
  out.u8(hello.default_divider);
  out.u8(static_cast<std::uint8_t>(hello.guests.size()));
  for (const GuestId& guest : hello.guests) out.short_text(guest.view());
  return size_of(out);
}

std::optional<Hello> parse_hello(Bytes body, HelloProblem& problem) {
  ByteReader in(body);
  Hello hello;
  hello.version = in.u8();
  hello.nonce = problem.nonce = in.u64();
  problem.is_other_version = in.ok() && hello.version != kWireVersion;
  if (problem.is_other_version) return std::nullopt;
  hello.token = in.u64();
  hello.link_time_us = in.i64();
  const std::size_t codecs = in.u8();
  if (hello.token == 0 || codecs == 0 || codecs > kMaxCodecs) return std::nullopt;
  for (std::size_t i = 0; i < codecs; ++i)
    if (!hello.codecs.try_push(read_codec(in))) return std::nullopt;
  const auto room = read_name(in);
  hello.default_divider = in.u8();
  const std::size_t guests = in.u8();
  if (!in.ok() || guests > kMaxGuestsPerLink) return std::nullopt;
  bool names_are_good = room.has_value();
  for (std::size_t i = 0; i < guests; ++i) {
    const auto guest = read_name(in);
    if (!in.ok()) return std::nullopt;
    if (!guest || hello.guests.contains(*guest) || !hello.guests.try_push(*guest))
      names_are_good = false;
  }
  if (!in.is_exhausted()) return std::nullopt;
  problem.is_bad_name = !names_are_good;
  if (!names_are_good) return std::nullopt;
  hello.room = *room;
  return hello;
}

std::size_t build(const Welcome& welcome, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kWelcome, out);
  out.u8(welcome.version);
  out.u64(welcome.nonce);
  out.u64(welcome.epoch);
  out.i64(welcome.link_time_us);
  out.i64(welcome.server_receive_us);
  out.i64(welcome.server_send_us);
  write_codec(welcome.codec, out);
  out.u8(static_cast<std::uint8_t>(welcome.slots.size()));
  for (const Slot& slot : welcome.slots) write_slot(slot, out);
  return size_of(out);
}

std::optional<Welcome> parse_welcome(Bytes body) {
  ByteReader in(body);
  Welcome welcome;
  welcome.version = in.u8();
  welcome.nonce = in.u64();
  welcome.epoch = in.u64();
  welcome.link_time_us = in.i64();
  welcome.server_receive_us = in.i64();
  welcome.server_send_us = in.i64();
  welcome.codec = read_codec(in);
  const std::size_t slots = in.u8();
  if (welcome.version != kWireVersion || slots > kMaxGuestsPerLink) return std::nullopt;
  for (std::size_t i = 0; i < slots; ++i) {
    const Slot slot = read_slot(in);
    if (slot.slot >= kSlotsPerPage || !welcome.slots.try_push(slot)) return std::nullopt;
  }
  if (!in.is_exhausted() || welcome.epoch == 0) return std::nullopt;
  return welcome;
}

std::size_t build(const RefusalNotice& refusal, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kRefusal, out);
  out.u8(refusal.server_version);
  out.u16(static_cast<std::uint16_t>(refusal.cause));
  out.u64(refusal.nonce);
  out.short_text(refusal.guest.view());
  if (refusal.cause == Refusal::kRemoved) out.u16(refusal.seconds);
  return size_of(out);
}

std::optional<RefusalNotice> parse_refusal(Bytes body) {
  ByteReader in(body);
  RefusalNotice refusal;
  refusal.server_version = in.u8();
  const std::uint16_t cause = in.u16();
  if (cause < static_cast<std::uint16_t>(Refusal::kVersion) ||
      cause > static_cast<std::uint16_t>(Refusal::kKeyGuests))
    return std::nullopt;
  refusal.cause = static_cast<Refusal>(cause);
  refusal.nonce = in.u64();
  const std::size_t length = in.u8();
  const std::string_view name = in.text(length);
  if (refusal.cause == Refusal::kRemoved) {
    refusal.seconds = in.u16();
    if (refusal.seconds == 0 || refusal.seconds > kMostRemoved_s) return std::nullopt;
  }
  if (!in.is_exhausted()) return std::nullopt;
  if (const auto guest = GuestId::parse(name)) refusal.guest = *guest;
  if (length != refusal.guest.view().size()) return std::nullopt;
  return refusal;
}

std::size_t build(const Ping& ping, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kPing, out);
  out.u32(ping.sequence);
  out.i64(ping.link_time_us);
  out.u32(ping.roster_version);
  out.u32(ping.round_trip_us);
  out.u32(ping.datagrams_received);
  out.u32(ping.poses_received);
  out.u32(ping.poses_lost);
  out.u32(ping.epoch);
  return size_of(out);
}

std::optional<Ping> parse_ping(Bytes body) {
  ByteReader in(body);
  Ping ping;
  ping.sequence = in.u32();
  ping.link_time_us = in.i64();
  ping.roster_version = in.u32();
  ping.round_trip_us = in.u32();
  ping.datagrams_received = in.u32();
  ping.poses_received = in.u32();
  ping.poses_lost = in.u32();
  ping.epoch = in.u32();
  return in.is_exhausted() ? std::optional(ping) : std::nullopt;
}

std::size_t build(const Pong& pong, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kPong, out);
  out.u32(pong.sequence);
  out.i64(pong.link_time_us);
  out.i64(pong.server_receive_us);
  out.i64(pong.server_send_us);
  out.u32(pong.datagrams_received);
  return size_of(out);
}

std::optional<Pong> parse_pong(Bytes body) {
  ByteReader in(body);
  Pong pong;
  pong.sequence = in.u32();
  pong.link_time_us = in.i64();
  pong.server_receive_us = in.i64();
  pong.server_send_us = in.i64();
  pong.datagrams_received = in.u32();
  return in.is_exhausted() ? std::optional(pong) : std::nullopt;
}

std::size_t build(const RosterPart& part, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kRoster, out);
  out.u32(part.version);
  out.u8(part.part);
  out.u8(part.parts);
  out.u8(part.first_slot);
  out.u8(part.slot_span);
  out.u8(static_cast<std::uint8_t>(part.entries.size()));
  for (const RosterEntry& entry : part.entries) {
    write_slot(entry.slot, out);
    out.short_text(entry.guest.view());
  }
  return size_of(out);
}

std::optional<RosterPart> parse_roster(Bytes body) {
  ByteReader in(body);
  RosterPart part;
  part.version = in.u32();
  part.part = in.u8();
  part.parts = in.u8();
  part.first_slot = in.u8();
  part.slot_span = in.u8();
  const std::size_t entries = in.u8();
  const std::size_t slots_end = std::size_t{part.first_slot} + part.slot_span;
  if (!in.ok() || part.version == 0 || part.parts == 0 || part.parts > 32 ||
      part.part >= part.parts || slots_end > kMaxGuestsPerRoom)
    return std::nullopt;
  for (std::size_t i = 0; i < entries; ++i) {
    RosterEntry entry;
    entry.slot = read_slot(in);
    const auto guest = read_name(in);
    if (!guest || entry.slot.slot < part.first_slot || entry.slot.slot >= slots_end)
      return std::nullopt;
    entry.guest = *guest;
    if (!part.entries.try_push(entry)) return std::nullopt;
  }
  return in.is_exhausted() ? std::optional(part) : std::nullopt;
}

std::size_t build(const InterestList& interest, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kInterest, out);
  out.u32(interest.version);
  out.u8(interest.default_divider);
  out.u8(static_cast<std::uint8_t>(interest.entries.size()));
  for (const InterestEntry& entry : interest.entries) {
    write_slot(entry.slot, out);
    out.u8(entry.divider);
  }
  if (interest.voices.is_default()) return size_of(out);
  out.u8(interest.voices.hears_others ? 1 : 0);
  out.u8(static_cast<std::uint8_t>(interest.voices.exceptions.size()));
  for (const Slot& slot : interest.voices.exceptions) write_slot(slot, out);
  return size_of(out);
}

namespace {

// As it is written: something that is not said by leaving it out.
bool read_voice_interest(ByteReader& in, VoiceInterest& voices) {
  const std::uint8_t hears_others = in.u8();
  const std::size_t exceptions = in.u8();
  voices.hears_others = hears_others == 1;
  for (std::size_t i = 0; i < exceptions; ++i) {
    const Slot slot = read_slot(in);
    if (!in.ok() || slot.slot >= kMaxGuestsPerRoom || !voices.exceptions.try_push(slot))
      return false;
  }
  return in.ok() && hears_others <= 1 && !voices.is_default();
}

}  // namespace

std::optional<InterestList> parse_interest_list(Bytes body) {
  ByteReader in(body);
  InterestList interest;
  interest.version = in.u32();
  interest.default_divider = in.u8();
  const std::size_t entries = in.u8();
  for (std::size_t i = 0; i < entries; ++i) {
    InterestEntry entry;
    entry.slot = read_slot(in);
    entry.divider = in.u8();
    if (!in.ok() || entry.slot.slot >= kMaxGuestsPerRoom || !interest.entries.try_push(entry))
      return std::nullopt;
  }
  if (in.ok() && in.remaining() > 0 && !read_voice_interest(in, interest.voices))
    return std::nullopt;
  if (!in.is_exhausted() || interest.version == 0) return std::nullopt;
  return interest;
}

std::size_t build_interest_ack(std::uint32_t version, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(Type::kInterestAck, out);
  out.u32(version);
  return size_of(out);
}

std::optional<std::uint32_t> parse_interest_ack(Bytes body) {
  ByteReader in(body);
  const std::uint32_t version = in.u32();
  return in.is_exhausted() && version != 0 ? std::optional(version) : std::nullopt;
}

std::size_t build_bare(Type type, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  write_opening(type, out);
  return size_of(out);
}

}  // namespace dance::wire
