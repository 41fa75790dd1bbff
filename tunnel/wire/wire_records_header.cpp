// What a datagram of records says before its records: acknowledgements, requests and feedback.
#include "tunnel/wire/wire_records.h"

namespace dance::wire {
namespace {

constexpr std::uint8_t kHasAcks = 1, kHasExcepts = 2, kHasWants = 4, kHasFeedback = 8,
                       kHasRecords = 16, kWantsRepeats = 32, kKnownFlags = 63;
constexpr std::uint8_t kFeedbackSlotMask = 0x3f;  // of feedback: a link's own are in the first page
static_assert(kFeedbackSlotMask + 1 == kSlotsPerPage);
constexpr std::uint8_t kHeldFlag = 0x80, kSpacingFlag = 0x40;
// Of the spacings: bits 0 and 1 base, high half intra frames.
constexpr std::uint8_t kBaseMask = 0x03, kBaseHeldFlag = 0x08;
constexpr std::uint8_t kLeastStill_log2 = 4;

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
        guest.base_log2 != 0 || guest.intra_log2 != kFewestIntra_log2 || guest.has_base_acked;
    out.u8(static_cast<std::uint8_t>(guest.slot | (guest.has_acked ? kHeldFlag : 0) |
                                     (has_spacing ? kSpacingFlag : 0)));
    out.u8(guest.restarts);
    out.u8(guest.intra_frames);
    if (guest.has_acked) {
      out.u16(guest.newest_acked);
      out.u16(guest.acked_before);
    }
    if (!has_spacing) continue;
    out.u8(static_cast<std::uint8_t>(guest.base_log2 | (guest.has_base_acked ? kBaseHeldFlag : 0) |
                                     guest.intra_log2 << 4));
    if (!guest.has_base_acked) continue;
    out.u16(guest.newest_base_acked);
    out.u16(guest.base_acked_before);
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
    guest.has_acked = (slot & kHeldFlag) != 0;
    guest.slot = slot & kFeedbackSlotMask;
    guest.restarts = in.u8();
    guest.intra_frames = in.u8();
    if (guest.has_acked) {
      guest.newest_acked = in.u16();
      guest.acked_before = in.u16();
    }
    if ((slot & kSpacingFlag) != 0) {
      const std::uint8_t spacing = in.u8();
      guest.base_log2 = spacing & kBaseMask;
      guest.intra_log2 = spacing >> 4;
      guest.has_base_acked = (spacing & kBaseHeldFlag) != 0;
      if ((spacing & ~(kBaseMask | kBaseHeldFlag | 0xf0)) != 0 ||
          guest.intra_log2 < kLeastStill_log2 || guest.intra_log2 > kFewestIntra_log2)
        return false;
      if (guest.has_base_acked) {
        guest.newest_base_acked = in.u16();
        guest.base_acked_before = in.u16();
      }
    }
    if (!feedback.guests.try_push(guest)) return false;
  }
  return in.ok();
}

}  // namespace

void begin_records(const RecordsHeader& header, ByteWriter& out) {
  const bool has_excepts = header.has_acks && !header.acks.excepts.empty();
  out.u8(static_cast<std::uint8_t>(
      kRecordsMark | (header.has_acks ? kHasAcks : 0) | (has_excepts ? kHasExcepts : 0) |
      (header.wants.empty() ? 0 : kHasWants) | (header.has_feedback ? kHasFeedback : 0) |
      (header.has_records ? kHasRecords : 0) |
      (header.has_feedback && header.feedback.wants_repeats ? kWantsRepeats : 0)));
  out.u16(header.number);
  if (header.has_acks) write_acks(header.acks, out);
  if (!header.wants.empty()) {
    out.u8(static_cast<std::uint8_t>(header.wants.size()));
    for (const std::uint8_t slot : header.wants) out.u8(slot);
  }
  if (header.has_feedback) write_feedback(header.feedback, out);
}

std::optional<RecordsHeader> parse_records_header(ByteReader& in) {
  RecordsHeader header;
  const auto flags = static_cast<std::uint8_t>(in.u8() & ~kRecordsMark);
  header.number = in.u16();
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
  // Records follow where it says so, and nowhere else.
  if (!in.ok() || (in.remaining() > 0) != header.has_records) return std::nullopt;
  return header;
}

}  // namespace dance::wire
