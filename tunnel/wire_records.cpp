#include "tunnel/wire_records.h"

namespace dance::wire {
namespace {

constexpr std::uint8_t kHasAcks = 1, kHasExcepts = 2, kHasWants = 4, kHasFeedback = 8,
                       kHasRecords = 16, kWantsRepeats = 32, kKnownFlags = 63;
constexpr std::uint8_t kSlotMask = 0x3f;  // 64 slots of a room
constexpr std::uint8_t kIsHands = 0x40, kIsWide = 0x80;
// Hands are always wide: narrow ones mean a message of a channel.
constexpr std::uint8_t kIsChannel = kIsHands;
constexpr std::uint8_t kHeldFlag = 0x80, kSpacingFlag = 0x40;
// Of the spacings: bits 0 and 1 base, high half stills.
constexpr std::uint8_t kBaseMask = 0x03, kBaseHeldFlag = 0x08;
constexpr std::uint8_t kLeastStill_log2 = 4;
constexpr std::uint8_t kLengthMask = 0x3f, kLongLength = 0x40, kHasAges = 0x80;
// Of the byte that follows a long length.
constexpr std::uint8_t kHighLengthMask = 0x0f, kNeedsNoOther = 0x10, kIsBase = 0x20,
                       kCountsLeftOut = 0x40, kIsKept = 0x80;
constexpr std::uint16_t kEscape = 0xffff;  // a number that does not fit follows
constexpr std::uint16_t kNoAgeTicks = 0xfffe;

void write_acks(const Acks& acks, ByteWriter& out) {
  out.u16(acks.newest);
  out.u32(acks.before);
  if (acks.excepts.empty()) return;
  out.u8(static_cast<std::uint8_t>(acks.excepts.size()));
  for (const AckExcept& except : acks.excepts) {
    out.u8(except.back);
    out.u8(except.slot);
  }
}

bool read_excepts(ByteReader& in, Acks& acks) {
  const std::size_t count = in.u8();
  if (count == 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    AckExcept except;
    except.back = in.u8();
    except.slot = in.u8();
    if (except.back >= kAckSpan || except.slot >= kMaxGuestsPerRoom ||
        !acks.excepts.try_push(except))
      return false;
  }
  return in.ok();
}

bool read_wants(ByteReader& in, FixedList<std::uint8_t, kMaxWants>& wants) {
  const std::size_t count = in.u8();
  if (count == 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t slot = in.u8();
    if (slot >= kMaxGuestsPerRoom || !wants.try_push(slot)) return false;
  }
  return in.ok();
}

void write_feedback(const Feedback& feedback, ByteWriter& out) {
  out.u16(feedback.loss);
  out.u16(feedback.in_a_row);
  out.u16(feedback.round_trip);
  out.u8(static_cast<std::uint8_t>(feedback.guests.size()));
  for (const GuestFeedback& guest : feedback.guests) {
    const bool has_spacing =
        guest.base_log2 != 0 || guest.still_log2 != kFewestStills_log2 || guest.has_base_held;
    out.u8(static_cast<std::uint8_t>(guest.slot | (guest.has_held ? kHeldFlag : 0) |
                                     (has_spacing ? kSpacingFlag : 0)));
    out.u8(guest.restarts);
    out.u8(guest.key_frames);
    if (guest.has_held) {
      out.u16(guest.newest_held);
      out.u16(guest.held_before);
    }
    if (!has_spacing) continue;
    out.u8(static_cast<std::uint8_t>(guest.base_log2 | (guest.has_base_held ? kBaseHeldFlag : 0) |
                                     guest.still_log2 << 4));
    if (!guest.has_base_held) continue;
    out.u16(guest.newest_base_held);
    out.u16(guest.base_held_before);
  }
}

bool read_feedback(ByteReader& in, Feedback& feedback) {
  feedback.loss = in.u16();
  feedback.in_a_row = in.u16();
  feedback.round_trip = in.u16();
  const std::size_t count = in.u8();
  for (std::size_t i = 0; i < count; ++i) {
    GuestFeedback guest;
    const std::uint8_t slot = in.u8();
    guest.has_held = (slot & kHeldFlag) != 0;
    guest.slot = slot & kSlotMask;
    guest.restarts = in.u8();
    guest.key_frames = in.u8();
    if (guest.has_held) {
      guest.newest_held = in.u16();
      guest.held_before = in.u16();
    }
    if ((slot & kSpacingFlag) != 0) {
      const std::uint8_t spacing = in.u8();
      guest.base_log2 = spacing & kBaseMask;
      guest.still_log2 = spacing >> 4;
      guest.has_base_held = (spacing & kBaseHeldFlag) != 0;
      if ((spacing & ~(kBaseMask | kBaseHeldFlag | 0xf0)) != 0 ||
          guest.still_log2 < kLeastStill_log2 || guest.still_log2 > kFewestStills_log2)
        return false;
      if (guest.has_base_held) {
        guest.newest_base_held = in.u16();
        guest.base_held_before = in.u16();
      }
    }
    if (guest.slot >= kMaxGuestsPerRoom || !feedback.guests.try_push(guest)) return false;
  }
  return in.ok();
}

void write_age(std::int32_t age_us, ByteWriter& out) {
  if (age_us == kNoAge) return out.u16(kNoAgeTicks);
  const std::int64_t ticks = to_ticks(age_us);
  if (ticks >= 0 && ticks < kNoAgeTicks) return out.u16(static_cast<std::uint16_t>(ticks));
  out.u16(kEscape);
  out.i32(age_us);
}

std::int32_t read_age(ByteReader& in) {
  const std::uint16_t ticks = in.u16();
  if (ticks == kNoAgeTicks) return kNoAge;
  return ticks == kEscape ? in.i32() : ticks * static_cast<std::int32_t>(kTick_us);
}

}  // namespace

void begin_records(const RecordsHeader& header, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(Type::kRecords));
  out.u16(header.number);
  const bool has_excepts = header.has_acks && !header.acks.excepts.empty();
  out.u8(static_cast<std::uint8_t>(
      (header.has_acks ? kHasAcks : 0) | (has_excepts ? kHasExcepts : 0) |
      (header.wants.empty() ? 0 : kHasWants) | (header.has_feedback ? kHasFeedback : 0) |
      (header.has_records ? kHasRecords : 0) |
      (header.has_feedback && header.feedback.wants_repeats ? kWantsRepeats : 0)));
  if (header.has_acks) write_acks(header.acks, out);
  if (!header.wants.empty()) {
    out.u8(static_cast<std::uint8_t>(header.wants.size()));
    for (const std::uint8_t slot : header.wants) out.u8(slot);
  }
  if (header.has_feedback) write_feedback(header.feedback, out);
  if (header.has_records) out.u24(static_cast<std::uint32_t>(header.base_ticks & 0xffffff));
}

std::optional<RecordsHeader> parse_records_header(ByteReader& in) {
  RecordsHeader header;
  header.number = in.u16();
  const std::uint8_t flags = in.u8();
  if (!in.ok() || (flags & ~kKnownFlags) != 0) return std::nullopt;
  header.has_acks = (flags & kHasAcks) != 0;
  header.has_feedback = (flags & kHasFeedback) != 0;
  header.has_records = (flags & kHasRecords) != 0;
  if (header.has_acks) {
    header.acks.newest = in.u16();
    header.acks.before = in.u32();
  }
  if ((flags & kHasExcepts) != 0 && (!header.has_acks || !read_excepts(in, header.acks)))
    return std::nullopt;
  if ((flags & kHasWants) != 0 && !read_wants(in, header.wants)) return std::nullopt;
  if (header.has_feedback && !read_feedback(in, header.feedback)) return std::nullopt;
  header.feedback.wants_repeats = (flags & kWantsRepeats) != 0;
  if (header.feedback.wants_repeats && !header.has_feedback) return std::nullopt;
  if (header.has_records) header.base_ticks = in.u24();
  // Records follow where it says so, and nowhere else.
  if (!in.ok() || (in.remaining() > 0) != header.has_records) return std::nullopt;
  return header;
}

std::int64_t base_us(std::int64_t base_ticks, std::int64_t near_us) {
  const std::int64_t near = to_ticks(near_us);
  // The difference modulo 2²⁴, as a signed number.
  const auto ahead =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(base_ticks - near) << 8) >> 8;
  return (near + ahead) * kTick_us;
}

namespace {

void add_channel_record(const Record& record, ByteWriter& out) {
  const std::size_t length = record.payload.size();
  out.u8(static_cast<std::uint8_t>(record.slot | kIsChannel));
  out.u8(
      static_cast<std::uint8_t>((length & kLengthMask) | (length > kLengthMask ? kLongLength : 0)));
  if (length > kLengthMask) out.u8(static_cast<std::uint8_t>(length >> 6));
  out.u8(static_cast<std::uint8_t>((record.stream >> 16 & 15) << 4 | (record.channel & 7)));
  out.u32(record.sequence);
  out.bytes(record.payload);
}

// Behind the slot and the length.
void read_channel_record(ByteReader& in, std::size_t length, Record& record) {
  record.kind = RecordKind::kChannel;
  const std::uint8_t tag = in.u8();
  record.stream = static_cast<std::uint32_t>(tag >> 4) << 16;
  record.channel = tag & 15;
  record.sequence = in.u32();
  record.payload = in.bytes(length);
}

}  // namespace

void add_record(const Record& record, bool is_narrow, std::int64_t base_ticks, ByteWriter& out) {
  if (record.kind == RecordKind::kChannel) return add_channel_record(record, out);
  const bool is_hands = record.kind == RecordKind::kHands;
  const bool has_ages = record.published_age_us != kNoAge || record.sent_age_us != kNoAge ||
                        record.server_age_us != kNoAge;
  const std::size_t length = record.payload.size();
  const auto more = static_cast<std::uint8_t>(
      length >> 6 | (record.needs_no_other ? kNeedsNoOther : 0) | (record.is_base ? kIsBase : 0) |
      (record.counts_left_out ? kCountsLeftOut : 0) | (record.is_kept ? kIsKept : 0));
  out.u8(static_cast<std::uint8_t>(record.slot | (is_hands ? kIsHands : 0) |
                                   (is_narrow ? 0 : kIsWide)));
  out.u8(static_cast<std::uint8_t>((length & kLengthMask) | (more != 0 ? kLongLength : 0) |
                                   (has_ages ? kHasAges : 0)));
  if (more != 0) out.u8(more);
  if (record.counts_left_out) out.u16(record.left_out);
  out.u8(static_cast<std::uint8_t>((record.stream >> 16 & 15) << 4 | (record.stream & 15)));
  if (is_narrow) {
    out.u8(static_cast<std::uint8_t>(record.sequence));
  } else {
    out.u16(static_cast<std::uint16_t>(record.stream));
    out.u32(record.sequence);
  }
  const std::int64_t before = base_ticks - to_ticks(record.capture_us);
  if (before >= 0 && before < kEscape) {
    out.u16(static_cast<std::uint16_t>(before));
  } else {
    out.u16(kEscape);
    out.i64(record.capture_us);
  }
  if (has_ages) {
    write_age(record.published_age_us, out);
    write_age(record.sent_age_us, out);
    write_age(record.server_age_us, out);
  }
  out.bytes(record.payload);
}

std::optional<Record> parse_record(std::int64_t base_us, ByteReader& in) {
  Record record;
  const std::uint8_t first = in.u8();
  const std::uint8_t length_byte = in.u8();
  record.kind = (first & kIsHands) != 0 ? RecordKind::kHands : RecordKind::kPose;
  record.slot = first & kSlotMask;
  record.is_narrow = (first & kIsWide) == 0;
  std::size_t length = length_byte & kLengthMask;
  const std::uint8_t more = (length_byte & kLongLength) != 0 ? in.u8() : 0;
  length |= static_cast<std::size_t>(more & kHighLengthMask) << 6;
  if ((first & (kIsHands | kIsWide)) == kIsChannel) {
    // Nothing more is said about a message than its length.
    if ((length_byte & kHasAges) != 0 || (more & ~kHighLengthMask) != 0) return std::nullopt;
    read_channel_record(in, length, record);
    if (!in.ok() || length == 0 || length > kMaxPayload || record.channel > 7) return std::nullopt;
    return record;
  }
  record.needs_no_other = (more & kNeedsNoOther) != 0;
  record.is_base = (more & kIsBase) != 0;
  record.is_kept = (more & kIsKept) != 0;
  record.counts_left_out = (more & kCountsLeftOut) != 0;
  if (record.counts_left_out) record.left_out = in.u16();
  const std::uint8_t tag = in.u8();
  record.stream = static_cast<std::uint32_t>(tag >> 4) << 16 | (tag & 15);
  if (record.is_narrow) {
    record.sequence = in.u8();
  } else {
    const std::uint16_t restarts = in.u16();
    if ((restarts & 15) != (tag & 15)) return std::nullopt;
    record.stream = static_cast<std::uint32_t>(tag >> 4) << 16 | restarts;
    record.sequence = in.u32();
  }
  const std::uint16_t before = in.u16();
  record.capture_us = before == kEscape ? in.i64() : base_us - before * kTick_us;
  if ((length_byte & kHasAges) != 0) {
    record.published_age_us = read_age(in);
    record.sent_age_us = read_age(in);
    record.server_age_us = read_age(in);
  }
  record.payload = in.bytes(length);
  if (!in.ok() || length == 0 || length > kMaxPayload) return std::nullopt;
  return record;
}

bool widen(std::uint16_t generation, bool has_any, std::uint32_t stream, std::uint32_t sequence,
           Record& record) {
  if ((record.stream >> 16 & 15) != (generation & 15u)) return false;
  auto restarts = static_cast<std::uint16_t>(record.stream);
  if (record.is_narrow) {
    if (!has_any || (record.stream & 15) != (stream & 15)) return false;
    restarts = static_cast<std::uint16_t>(stream);
    record.sequence = sequence + static_cast<std::uint32_t>(static_cast<std::int8_t>(
                                     static_cast<std::uint8_t>(record.sequence - sequence)));
    record.is_narrow = false;
  }
  record.stream = std::uint32_t{generation} << 16 | restarts;
  return true;
}

}  // namespace dance::wire
