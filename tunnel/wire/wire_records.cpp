#include "tunnel/wire/wire_records.h"

namespace dance::wire {
namespace {

constexpr std::uint8_t kSlotMask = 0x3f;  // the slot in its page
static_assert(kSlotMask + 1 == kSlotsPerPage);
constexpr std::uint8_t kPage = 0;  // instead of a length: another page of slots follows
constexpr std::uint8_t kIsHands = 0x40, kIsWide = 0x80;
// Hands are always wide: narrow ones mean a message of a channel.
constexpr std::uint8_t kIsChannel = kIsHands;
constexpr std::uint8_t kLengthMask = 0x3f, kLongLength = 0x40, kIsBrief = 0x80;
// Of a narrow record's sequence.
constexpr std::uint8_t kSequenceMask = 0x3f, kOddGeneration = 0x40, kOddRestarts = 0x80;
// Of the byte that follows a long length.
constexpr std::uint8_t kHighLengthMask = 0x0f, kIsIntra = 0x10, kIsBase = 0x20,
                       kCountsLeftOut = 0x40, kIsRetained = 0x80;
constexpr std::uint16_t kEscape = 0xffff;  // a number that does not fit follows
constexpr std::uint16_t kNoAgeTicks = 0xfffe;
// Of captures: after the one before, or whole, the low 24 bits. Ages follow, and the capture once
// more.
constexpr std::uint16_t kMiddle = 0x8000, kAgesFollow = 0xfffe;
constexpr std::uint32_t kWholeEscape = 0xffffff, kWholeAgesFollow = 0xfffffe;
// Beyond it nothing can be reckoned; the receiver of a record asks for much nearer.
constexpr std::int64_t kFarthestCapture_us = std::int64_t{1} << 60;
// What is further off is told in full: half of what 24 bits reach.
constexpr std::int64_t kWholeReach = 1 << 22;

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

void write_capture(const Record& record, bool has_ages, const RecordChain& chain, ByteWriter& out) {
  const std::int64_t ticks = to_ticks(record.capture_us);
  if (chain.has_any) {
    if (has_ages) out.u16(kAgesFollow);
    const std::int64_t after = ticks - chain.capture_ticks + kMiddle;
    if (after >= 0 && after < kAgesFollow) return out.u16(static_cast<std::uint16_t>(after));
    out.u16(kEscape);
  } else {
    if (has_ages) out.u24(kWholeAgesFollow);
    const auto low = static_cast<std::uint32_t>(ticks & 0xffffff);
    const std::int64_t off = ticks - to_ticks(chain.near_us);
    if (off > -kWholeReach && off < kWholeReach && low < kWholeAgesFollow) return out.u24(low);
    out.u24(kWholeEscape);
  }
  out.i64(record.capture_us);
}

bool read_capture(ByteReader& in, const RecordChain& chain, bool& has_ages, Record& record) {
  std::uint32_t told = chain.has_any ? in.u16() : in.u24();
  const std::uint32_t ages_follow = chain.has_any ? kAgesFollow : kWholeAgesFollow;
  has_ages = told == ages_follow;
  if (has_ages) told = chain.has_any ? in.u16() : in.u24();
  if (told == ages_follow) return false;
  if (told > ages_follow) {
    record.capture_us = in.i64();
    return record.capture_us > -kFarthestCapture_us && record.capture_us < kFarthestCapture_us;
  }
  if (chain.has_any)
    record.capture_us =
        (chain.capture_ticks + static_cast<std::int64_t>(told) - kMiddle) * kTick_us;
  else
    record.capture_us = capture_near(told, to_ticks(chain.near_us)) * kTick_us;
  return true;
}

void go_on(RecordChain& chain, const Record& record) {
  chain.has_any = true;
  chain.slot = record.slot;
  chain.capture_ticks = to_ticks(record.capture_us);
}

std::uint8_t page_of(std::uint8_t slot) { return slot / kSlotsPerPage; }
std::uint8_t in_page(const RecordChain& chain, unsigned slot) {
  return static_cast<std::uint8_t>(chain.page * kSlotsPerPage + (slot & kSlotMask));
}
std::uint8_t next_slot(const RecordChain& chain) { return in_page(chain, chain.slot + 1u); }

std::uint8_t narrow_sequence(const Record& record) {
  return static_cast<std::uint8_t>((record.sequence & kSequenceMask) |
                                   ((record.stream >> 16 & 1) != 0 ? kOddGeneration : 0) |
                                   ((record.stream & 1) != 0 ? kOddRestarts : 0));
}

void read_narrow(std::uint8_t sequence, Record& record) {
  record.is_narrow = true;
  record.sequence = sequence & kSequenceMask;
  record.stream = ((sequence & kOddGeneration) != 0 ? 1u << 16 : 0u) |
                  ((sequence & kOddRestarts) != 0 ? 1u : 0u);
}

// Behind length and slot.
void add_channel_record(const Record& record, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>((record.stream >> 16 & 15) << 4 | (record.channel & 7)));
  out.u32(record.sequence);
  out.bytes(record.payload);
}

void read_channel_record(ByteReader& in, std::size_t length, Record& record) {
  record.kind = RecordKind::kChannel;
  const std::uint8_t tag = in.u8();
  record.stream = static_cast<std::uint32_t>(tag >> 4) << 16;
  record.channel = tag & 15;
  record.sequence = in.u32();
  record.payload = in.bytes(length);
}

}  // namespace

void add_record(const Record& record, bool is_narrow, RecordChain& chain, ByteWriter& out) {
  const bool is_channel = record.kind == RecordKind::kChannel;
  const bool is_hands = record.kind == RecordKind::kHands;
  const bool has_ages = record.published_age_us != kNoAge || record.sent_age_us != kNoAge ||
                        record.server_age_us != kNoAge;
  const std::size_t length = record.payload.size();
  // Nothing more is said about a message than its length.
  const auto flags = static_cast<std::uint8_t>(
      is_channel ? 0
                 : (record.is_intra ? kIsIntra : 0) | (record.is_base ? kIsBase : 0) |
                       (record.counts_left_out ? kCountsLeftOut : 0) |
                       (record.is_retained ? kIsRetained : 0));
  const auto more = static_cast<std::uint8_t>(length >> 6 | flags);
  const std::int64_t after = to_ticks(record.capture_us) - chain.capture_ticks;
  if (page_of(record.slot) != chain.page) {
    chain.page = page_of(record.slot);
    out.u8(kPage);
    out.u8(chain.page);
  }
  if (is_narrow && !has_ages && more == 0 && chain.has_any && record.slot == next_slot(chain) &&
      after >= INT8_MIN && after <= INT8_MAX) {
    out.u8(static_cast<std::uint8_t>(length | kIsBrief));
    out.u8(narrow_sequence(record));
    out.u8(static_cast<std::uint8_t>(after));
    out.bytes(record.payload);
    return go_on(chain, record);
  }
  out.u8(static_cast<std::uint8_t>((length & kLengthMask) | (more != 0 ? kLongLength : 0)));
  if (more != 0) out.u8(more);
  out.u8(static_cast<std::uint8_t>((record.slot & kSlotMask) |
                                   (is_hands || is_channel ? kIsHands : 0) |
                                   (is_narrow || is_channel ? 0 : kIsWide)));
  if (is_channel) return add_channel_record(record, out);
  if (record.counts_left_out) out.u16(record.left_out);
  if (is_narrow) {
    out.u8(narrow_sequence(record));
  } else {
    out.u8(static_cast<std::uint8_t>((record.stream >> 16 & 15) << 4 | (record.stream & 15)));
    out.u16(static_cast<std::uint16_t>(record.stream));
    out.u32(record.sequence);
  }
  write_capture(record, has_ages, chain, out);
  if (has_ages) {
    write_age(record.published_age_us, out);
    write_age(record.sent_age_us, out);
    write_age(record.server_age_us, out);
  }
  out.bytes(record.payload);
  go_on(chain, record);
}

namespace {

std::optional<Record> parse_brief(std::uint8_t length, RecordChain& chain, ByteReader& in) {
  if (!chain.has_any) return std::nullopt;
  Record record;
  record.slot = next_slot(chain);
  read_narrow(in.u8(), record);
  record.capture_us = (chain.capture_ticks + static_cast<std::int8_t>(in.u8())) * kTick_us;
  record.payload = in.bytes(length);
  if (!in.ok() || length == 0) return std::nullopt;
  go_on(chain, record);
  return record;
}

bool read_numbers(ByteReader& in, Record& record) {
  const std::uint8_t tag = in.u8();
  const std::uint16_t restarts = in.u16();
  record.stream = static_cast<std::uint32_t>(tag >> 4) << 16 | restarts;
  record.sequence = in.u32();
  return (restarts & 15) == (tag & 15);
}

}  // namespace

std::optional<Record> parse_record(RecordChain& chain, ByteReader& in) {
  std::uint8_t length_byte = in.u8();
  if (length_byte == kPage) {
    const std::uint8_t page = in.u8();
    if (!in.ok() || page == chain.page || page >= kMaxGuestsPerRoom / kSlotsPerPage)
      return std::nullopt;
    chain.page = page;
    length_byte = in.u8();
    if (length_byte == kPage) return std::nullopt;
  }
  std::size_t length = length_byte & kLengthMask;
  if ((length_byte & kIsBrief) != 0) {
    if ((length_byte & kLongLength) != 0) return std::nullopt;
    return parse_brief(static_cast<std::uint8_t>(length), chain, in);
  }
  const std::uint8_t more = (length_byte & kLongLength) != 0 ? in.u8() : 0;
  length |= static_cast<std::size_t>(more & kHighLengthMask) << 6;
  Record record;
  const std::uint8_t first = in.u8();
  record.kind = (first & kIsHands) != 0 ? RecordKind::kHands : RecordKind::kPose;
  record.slot = in_page(chain, first);
  if ((first & (kIsHands | kIsWide)) == kIsChannel) {
    if ((more & ~kHighLengthMask) != 0) return std::nullopt;
    read_channel_record(in, length, record);
    if (!in.ok() || length == 0 || length > kMaxPayload || record.channel > 7) return std::nullopt;
    return record;
  }
  record.is_intra = (more & kIsIntra) != 0;
  record.is_base = (more & kIsBase) != 0;
  record.is_retained = (more & kIsRetained) != 0;
  record.counts_left_out = (more & kCountsLeftOut) != 0;
  if (record.counts_left_out) record.left_out = in.u16();
  if ((first & kIsWide) == 0)
    read_narrow(in.u8(), record);
  else if (!read_numbers(in, record))
    return std::nullopt;
  bool has_ages = false;
  if (!read_capture(in, chain, has_ages, record)) return std::nullopt;
  if (has_ages) {
    record.published_age_us = read_age(in);
    record.sent_age_us = read_age(in);
    record.server_age_us = read_age(in);
  }
  record.payload = in.bytes(length);
  if (!in.ok() || length == 0 || length > kMaxPayload) return std::nullopt;
  go_on(chain, record);
  return record;
}

bool widen(std::uint16_t generation, bool has_any, std::uint32_t stream, std::uint32_t sequence,
           Record& record) {
  const std::uint32_t known = record.is_narrow ? 1 : 15;
  if ((record.stream >> 16 & known) != (generation & known)) return false;
  auto restarts = static_cast<std::uint16_t>(record.stream);
  if (record.is_narrow) {
    if (!has_any || (record.stream & 1) != (stream & 1)) return false;
    restarts = static_cast<std::uint16_t>(stream);
    // The difference modulo 64. Further ahead than the reach is none: it came late.
    std::uint32_t ahead = (record.sequence - sequence) & kSequenceMask;
    if (ahead > kNarrowReach) ahead -= kSequenceMask + 1;
    record.sequence = sequence + ahead;
    record.is_narrow = false;
  }
  record.stream = std::uint32_t{generation} << 16 | restarts;
  return true;
}

}  // namespace dance::wire
