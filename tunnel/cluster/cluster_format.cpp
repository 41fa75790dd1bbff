#include "tunnel/cluster/cluster_format.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "tunnel/cluster/cluster_fields.h"

namespace dance::cluster {
namespace {

// Of a record, and of a guest's common frames.
constexpr std::uint8_t kIsIntra = 1, kIsBase = 2, kKnownRecordFlags = 3;
constexpr std::uint8_t kHasFull = 1, kHasBase = 2, kKnownFrameFlags = 3;

void write(const Heartbeat& beat, ByteWriter& out) {
  begin(Type::kHeartbeat, out);
  out.u64(beat.server);
  out.i64(beat.born_us);
  out.u32(beat.links);
  out.u32(beat.guests);
  out.u8(beat.is_leaving ? 1 : 0);
  wire::write_address(beat.address, out);
}
std::optional<Message> read_beat(ByteReader& in) {
  Heartbeat beat;
  const bool is_good = read_server(in, beat.server);
  beat.born_us = in.i64();
  beat.links = in.u32();
  beat.guests = in.u32();
  const std::uint8_t is_leaving = in.u8();
  beat.is_leaving = is_leaving == 1;
  if (!is_good || !is_near(beat.born_us) || is_leaving > 1 || !wire::read_address(in, beat.address))
    return std::nullopt;
  return beat;
}

void write(const ClockQuestion& question, ByteWriter& out) {
  begin(Type::kClockQuestion, out);
  out.u64(question.server);
  out.i64(question.asked_us);
}
std::optional<Message> read_question(ByteReader& in) {
  ClockQuestion question;
  const bool is_good = read_server(in, question.server);
  question.asked_us = in.i64();
  if (!is_good || !is_near(question.asked_us)) return std::nullopt;
  return question;
}

void write(const ClockAnswer& answer, ByteWriter& out) {
  begin(Type::kClockAnswer, out);
  out.u64(answer.server);
  out.i64(answer.asked_us);
  out.i64(answer.received_us);
  out.i64(answer.sent_us);
}
std::optional<Message> read_answer(ByteReader& in) {
  ClockAnswer answer;
  const bool is_good = read_server(in, answer.server);
  answer.asked_us = in.i64();
  answer.received_us = in.i64();
  answer.sent_us = in.i64();
  if (!is_good || !is_near(answer.asked_us) || !is_near(answer.received_us) ||
      !is_near(answer.sent_us))
    return std::nullopt;
  return answer;
}

void write(const RecordMessage& message, ByteWriter& out) {
  const wire::Record& record = message.record;
  begin(Type::kRecord, out);
  out.u64(message.server);
  out.u64(message.link_token);
  out.u8(static_cast<std::uint8_t>(record.kind));
  out.u8(
      static_cast<std::uint8_t>((record.is_intra ? kIsIntra : 0) | (record.is_base ? kIsBase : 0)));
  out.u16(static_cast<std::uint16_t>(record.stream));
  out.u32(record.sequence);
  out.u8(record.channel);
  out.i64(record.capture_us);
  out.i32(record.published_age_us);
  out.i32(record.sent_age_us);
  out.i32(record.server_age_us);
  out.bytes(record.payload);
}
std::optional<Message> read_record(ByteReader& in) {
  RecordMessage message;
  wire::Record& record = message.record;
  const bool is_good = read_server(in, message.server);
  message.link_token = in.u64();
  const std::uint8_t kind = in.u8();
  const std::uint8_t flags = in.u8();
  record.stream = in.u16();
  record.sequence = in.u32();
  record.channel = in.u8();
  record.capture_us = in.i64();
  record.published_age_us = in.i32();
  record.sent_age_us = in.i32();
  record.server_age_us = in.i32();
  record.payload = in.bytes(in.remaining());
  record.kind = static_cast<wire::RecordKind>(kind);
  record.is_intra = (flags & kIsIntra) != 0;
  record.is_base = (flags & kIsBase) != 0;
  const bool is_channel = record.kind == wire::RecordKind::kChannel;
  if (!is_good || kind < 1 || kind > 3 || (flags & ~kKnownRecordFlags) != 0 ||
      !is_near(record.capture_us) || record.payload.size() > wire::kMaxPayload ||
      (record.payload.empty() && !is_channel) ||
      record.channel >= (is_channel ? kMaxChannelsPerGuest : 1))
    return std::nullopt;
  return message;
}

void write(const VoiceMessage& message, ByteWriter& out) {
  begin(Type::kVoice, out);
  out.u64(message.server);
  out.u64(message.link_token);
  out.u32(message.record.sequence);
  out.i64(message.record.capture_us);
  out.u8(static_cast<std::uint8_t>(-message.record.level_dbfs));
  out.u8(static_cast<std::uint8_t>(message.record.packet.size()));
  out.bytes(message.record.packet);
}
std::optional<Message> read_voice(ByteReader& in) {
  VoiceMessage message;
  const bool is_good = read_server(in, message.server);
  message.link_token = in.u64();
  message.record.sequence = in.u32();
  message.record.capture_us = in.i64();
  const std::uint8_t below_full = in.u8();
  message.record.packet = in.bytes(in.u8());
  message.record.level_dbfs = static_cast<std::int8_t>(-below_full);
  if (!is_good || !is_near(message.record.capture_us) || below_full > -kSilence_dbfs ||
      message.record.packet.empty() || message.record.packet.size() > kMaxVoiceBytes)
    return std::nullopt;
  return message;
}

void write(const FrameWindow& frames, ByteWriter& out) {
  out.u16(static_cast<std::uint16_t>(frames.stream()));
  out.u16(frames.newest());
  out.u64(frames.bits());
}
// The newest is among the frames, or there are none.
bool read_frames(ByteReader& in, FrameWindow& frames) {
  const std::uint16_t stream = in.u16();
  const std::uint16_t newest = in.u16();
  const std::uint64_t bits = in.u64();
  frames = {stream, newest, bits};
  return in.ok() && frames.bits() == bits;
}

void write(const FeedbackMessage& message, ByteWriter& out) {
  begin(Type::kFeedback, out);
  out.u64(message.server);
  write_name(message.room, out);
  out.u8(message.path.has_receiver ? 1 : 0);
  out.u16(message.path.loss);
  out.u16(message.path.in_a_row);
  out.u16(message.path.round_trip);
  out.u8(static_cast<std::uint8_t>(message.entries.size()));
  for (const FeedbackEntry& entry : message.entries) {
    const CommonFrames& frames = entry.feedback.frames;
    write_name(entry.guest, out);
    out.u8(entry.feedback.intra_frames);
    out.u8(static_cast<std::uint8_t>((frames.has_full ? kHasFull : 0) |
                                     (frames.has_base ? kHasBase : 0)));
    out.u8(frames.base_log2);
    out.u8(frames.intra_log2);
    if (frames.has_full) write(frames.full, out);
    if (frames.has_base) write(frames.base, out);
  }
}
bool read_entry(ByteReader& in, FeedbackEntry& entry) {
  CommonFrames& frames = entry.feedback.frames;
  if (!read_set_name(in, entry.guest)) return false;
  entry.feedback.intra_frames = in.u8();
  const std::uint8_t flags = in.u8();
  frames.base_log2 = in.u8();
  frames.intra_log2 = in.u8();
  frames.has_full = (flags & kHasFull) != 0;
  frames.has_base = (flags & kHasBase) != 0;
  if (frames.has_full && !read_frames(in, frames.full)) return false;
  if (frames.has_base && !read_frames(in, frames.base)) return false;
  return in.ok() && (flags & ~kKnownFrameFlags) == 0 && frames.base_log2 <= kFewestIntra_log2 &&
         frames.intra_log2 <= kFewestIntra_log2;
}
std::optional<Message> read_feedback(ByteReader& in) {
  FeedbackMessage message;
  if (!read_server(in, message.server) || !read_set_name(in, message.room)) return std::nullopt;
  const std::uint8_t has_receiver = in.u8();
  message.path.has_receiver = has_receiver == 1;
  message.path.loss = in.u16();
  message.path.in_a_row = in.u16();
  message.path.round_trip = in.u16();
  const std::size_t count = in.u8();
  if (!in.ok() || has_receiver > 1 || count > kMaxFeedbackEntries) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    FeedbackEntry entry;
    if (!read_entry(in, entry)) return std::nullopt;
    entry.feedback.path = message.path;
    if (!message.entries.try_push(entry)) return std::nullopt;
  }
  return message;
}

// As between server and links, with the slot 0.
void write(const FileMessage& message, ByteWriter& out) {
  begin(Type::kFile, out);
  out.u64(message.server);
  write_name(message.room, out);
  write_name(message.guest, out);
  std::array<std::uint8_t, wire::kMaxPlain> datagram;
  const std::size_t size = std::visit(
      [&](auto part) {
        part.file.slot = wire::Slot();
        return wire::build(part, datagram);
      },
      message.part);
  out.bytes(std::span(datagram).first(size));
}
template <class Part>
bool take_part_of_file(const std::optional<Part>& part, FilePart& into) {
  if (!part || part->file.slot != wire::Slot()) return false;
  into = *part;
  return true;
}
std::optional<Message> read_file(ByteReader& in) {
  FileMessage message;
  if (!read_server(in, message.server) || !read_set_name(in, message.room) ||
      !read_set_name(in, message.guest))
    return std::nullopt;
  const auto type = static_cast<wire::Type>(in.u8());
  const Bytes body = in.bytes(in.remaining());
  const bool is_good = type == wire::Type::kFileWant
                           ? take_part_of_file(wire::parse_file_want(body), message.part)
                       : type == wire::Type::kFileChunk
                           ? take_part_of_file(wire::parse_file_chunk(body), message.part)
                       : type == wire::Type::kFileRefusal
                           ? take_part_of_file(wire::parse_file_refusal(body), message.part)
                           : false;
  if (!in.ok() || !is_good) return std::nullopt;
  return message;
}

void write(const RemovalMessage& message, ByteWriter& out) {
  begin(Type::kRemoval, out);
  out.u64(message.server);
  write_name(message.room, out);
  write_name(message.notice.guest, out);
  out.u64(message.notice.link_token);
  write_name(message.notice.key, out);
  out.u8(message.notice.is_done ? 1 : 0);
}
std::optional<Message> read_removal(ByteReader& in) {
  RemovalMessage message;
  if (!read_server(in, message.server) || !read_set_name(in, message.room) ||
      !read_set_name(in, message.notice.guest))
    return std::nullopt;
  message.notice.link_token = in.u64();
  if (!read_name(in, message.notice.key)) return std::nullopt;
  const std::uint8_t is_done = in.u8();
  message.notice.is_done = is_done == 1;
  if (!in.ok() || is_done > 1 || message.notice.link_token == 0) return std::nullopt;
  return message;
}

}  // namespace

std::size_t build(const Message& message, std::span<std::uint8_t> out) {
  return build_any(message, out, [](const auto& one, ByteWriter& to) { write(one, to); });
}

std::optional<Message> parse_message(Bytes bytes) {
  ByteReader in(bytes);
  const auto type = opening(in);
  if (!type) return std::nullopt;
  std::optional<Message> message;
  switch (*type) {
    case Type::kHeartbeat:
      message = read_beat(in);
      break;
    case Type::kClockQuestion:
      message = read_question(in);
      break;
    case Type::kClockAnswer:
      message = read_answer(in);
      break;
    case Type::kRecord:
      message = read_record(in);
      break;
    case Type::kFeedback:
      message = read_feedback(in);
      break;
    case Type::kFile:
      message = read_file(in);
      break;
    case Type::kVoice:
      message = read_voice(in);
      break;
    case Type::kRemoval:
      message = read_removal(in);
      break;
    default:
      return std::nullopt;
  }
  return in.is_exhausted() ? message : std::nullopt;
}

}  // namespace dance::cluster
