// The datagram that the dance travels in, built and parsed: a header with its number, what was
// received from the other side and what is asked of it, then records of poses, hands and
// messages of further channels. Each datagram can be read for itself but for the high bits of a
// narrow record's numbers, which are those of what the receiver is known to have.
// docs/wire-format.md says it byte by byte.
//
// Units/frames: little-endian; times are of the server's clock, on the wire in ticks of 16 µs.
// Ownership:    payloads are views of the caller's bytes.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h; nothing here allocates.
#pragma once

#include "tunnel/policy/pose_share.h"
#include "tunnel/wire/wire.h"

namespace dance::wire {

constexpr std::int64_t kTick_us = 16;
constexpr std::int64_t to_ticks(std::int64_t us) { return (us + kTick_us / 2) >> 4; }
// The number of ticks near to `near` whose low 24 bits these are.
constexpr std::int64_t capture_near(std::uint32_t low, std::int64_t near) {
  return near + (static_cast<std::int32_t>((low - static_cast<std::uint32_t>(near)) << 8) >> 8);
}

// Acknowledges a datagram but for the pose of one guest in it.
struct AckExcept {
  std::uint8_t back = 0;  // newest − back is the datagram
  std::uint8_t slot = 0;
};
constexpr std::size_t kMaxAckExcepts = 32;
// Datagrams of the other side whose poses were all decoded, but for the exceptions.
struct Acks {
  std::uint16_t newest = 0;
  std::uint32_t before = 0;  // bit i: newest − 1 − i
  FixedList<AckExcept, kMaxAckExcepts> excepts;
};
constexpr std::uint8_t kAckSpan = 33;

// From the server to a link, about one guest of the link.
struct GuestFeedback {
  std::uint8_t slot = 0;
  std::uint8_t restarts = 0;      // low byte of the stream that it speaks of
  std::uint8_t intra_frames = 0;  // counts intra frames asked for; a change asks for one
  bool has_acked = false;         // whether all receivers have some frame in common
  std::uint16_t newest_acked = 0;
  std::uint16_t acked_before = 0;  // bit i: newest − 1 − i
  // For receivers who want less than all. Each 2^n-th pose should be a base frame (0: none has to
  // be), and refer only to what those have too;
  std::uint8_t base_log2 = 0;
  bool has_base_acked = false;
  std::uint16_t newest_base_acked = 0;
  std::uint16_t base_acked_before = 0;
  // and each 2^n-th should be an intra frame.
  std::uint8_t intra_log2 = kFewestIntra_log2;

  bool operator==(const GuestFeedback&) const = default;
};
struct Feedback {
  bool wants_repeats = false;    // the link's way loses some: each pose is to go once more
  std::uint16_t loss = 0;        // of the way to the worst receiver, in 1/65,536
  std::uint16_t in_a_row = 0;    // of that what is lost together with the datagram before, 1/65,536
  std::uint16_t round_trip = 0;  // to the worst receiver and back, in 0.1 ms; 0 = not known
  FixedList<GuestFeedback, kMaxGuestsPerLink> guests;
};

constexpr std::size_t kMaxWants = 16;
struct RecordsHeader {
  std::uint16_t number = 0;  // of this datagram, counted for each session and direction
  bool has_acks = false;
  Acks acks;
  FixedList<std::uint8_t, kMaxWants> wants;  // slots that the link needs an intra frame of
  bool has_feedback = false;
  Feedback feedback;
  bool has_records = false;
};
// Flags, number and acks: what always fits beside kMaxRecordsBody.
constexpr std::size_t kRecordsHeader = 1 + 2 + 6;
constexpr std::size_t kMaxRecordsBody = kMaxPlain - kRecordsHeader;

enum class RecordKind : std::uint8_t { kPose = 1, kHands = 2, kChannel = 3 };

constexpr std::int32_t kNoAge = INT32_MIN;  // that step left no stamp

// One pose, one pair of hands, or one message of a further channel, of one guest.
struct Record {
  RecordKind kind = RecordKind::kPose;
  std::uint8_t slot = 0;
  // High half: the guest's generation, of which 4 bits travel. Low half: counts restarts of the
  // producer, written by the link.
  std::uint32_t stream = 0;
  std::uint32_t sequence = 0;
  std::uint8_t channel = 0;  // of a channel's message: which; it has no times
  std::int64_t capture_us = 0;
  // From capture to the step, which keeps hops right whatever the clocks do afterwards. Not every
  // record brings them.
  std::int32_t published_age_us = kNoAge;
  std::int32_t sent_age_us = kNoAge;
  std::int32_t server_age_us = kNoAge;  // written by the server
  Bytes payload;
  // From a link: what receivers who want less than all can decode.
  bool is_intra = false;
  bool is_base = false;
  // From the server: made before the receiver came, or before it was asked for; and how many poses
  // of this stream the receiver was not sent so far, where some were not.
  bool is_retained = false;
  bool counts_left_out = false;
  std::uint16_t left_out = 0;
  // As parsed: only 1 bit of generation and restarts each, and 6 of the sequence, have come.
  bool is_narrow = false;
};
// Without ages, payload below 64 bytes, behind another in the datagram; the first takes one more.
constexpr std::size_t kBriefRecordHeader =
    3;  // narrow, of the next slot and nearly the same moment
constexpr std::size_t kNarrowRecordHeader = 5;
constexpr std::size_t kWideRecordHeader = 11;
constexpr std::size_t kMaxRecordHeader = 2 + kWideRecordHeader + 1 + 1 + 2 + 8 + 3 + 18;
// How far a record may be ahead of what the receiver has for its numbers to travel narrow.
constexpr std::uint16_t kNarrowReach = 24;

// What the next record of a datagram says by how it differs from the one before.
struct RecordChain {
  std::int64_t near_us = 0;  // about now, by the server's clock
  bool has_any = false;
  std::uint8_t slot = 0;
  std::int64_t capture_ticks = 0;
  std::uint8_t page = 0;  // of the slots that follow
};

// The opening and the header; records follow.
void begin_records(const RecordsHeader& header, ByteWriter& out);
void add_record(const Record& record, bool is_narrow, RecordChain& chain, ByteWriter& out);

// The header and, where it says so, room for records behind it.
std::optional<RecordsHeader> parse_records_header(ByteReader& in);
// One record; call until the reader is_exhausted().
std::optional<Record> parse_record(RecordChain& chain, ByteReader& in);
// Gives a record its whole numbers: the generation that is the slot's, and the rest of what came
// before. False where they contradict each other, or nothing came before.
bool widen(std::uint16_t generation, bool has_any, std::uint32_t stream, std::uint32_t sequence,
           Record& record);

}  // namespace dance::wire
