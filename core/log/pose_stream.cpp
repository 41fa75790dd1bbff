#include "core/log/pose_stream.h"

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"

namespace dance {
namespace {

constexpr unsigned kHopMarks = (1u << kHopCount) - 1;
constexpr unsigned kSequenceMark = 1u << 6;
constexpr unsigned kClockMark = 1u << 7;
static_assert(kHopCount == 6);

// All differences are modulo 2^64, so that any two numbers have one. Small ones of either sign take
// one byte.
void put_difference(ByteWriter& out, std::uint64_t difference) {
  std::uint64_t rest = (difference << 1) ^ (0 - (difference >> 63));
  for (; rest >= 0x80; rest >>= 7) out.u8(static_cast<std::uint8_t>(rest | 0x80));
  out.u8(static_cast<std::uint8_t>(rest));
}

std::uint64_t get_difference(ByteReader& in) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint64_t byte = in.u8();
    value |= (byte & 0x7f) << shift;
    if ((byte & 0x80) == 0) break;
  }
  return (value >> 1) ^ (0 - (value & 1));
}

std::uint64_t unsigned_of(std::int64_t us) { return static_cast<std::uint64_t>(us); }
std::int64_t signed_of(std::uint64_t us) { return static_cast<std::int64_t>(us); }

void put_head(ByteWriter& out, const RawPose& raw, PoseHead& head) {
  unsigned marks = 0;
  for (std::size_t i = 0; i < kHopCount; ++i)
    if (raw.hop_time_us[i] != 0) marks |= 1u << i;
  if (raw.pose.sequence != head.sequence + 1) marks |= kSequenceMark;
  if (raw.pose.clock_id != head.clock_id) marks |= kClockMark;
  out.u8(static_cast<std::uint8_t>(marks));
  if ((marks & kSequenceMark) != 0) {
    // Sign-extended, so that a small step back is as short as one ahead.
    const std::uint32_t step = raw.pose.sequence - (head.sequence + 1);
    put_difference(out, unsigned_of(static_cast<std::int32_t>(step)));
  }
  if ((marks & kClockMark) != 0) put_difference(out, raw.pose.clock_id - head.clock_id);
  head.sequence = raw.pose.sequence;
  head.clock_id = raw.pose.clock_id;

  const std::uint64_t captured = unsigned_of(raw.capture_time_us);
  const std::uint64_t step_us = captured - head.capture_time_us;
  put_difference(out, step_us - head.step_us);
  head.capture_time_us = captured;
  head.step_us = step_us;

  std::uint64_t before = captured;
  for (std::size_t i = 0; i < kHopCount; ++i) {
    if ((marks & (1u << i)) == 0) continue;
    const std::uint64_t hop = unsigned_of(raw.hop_time_us[i]);
    put_difference(out, hop - before - head.gap_us[i]);
    head.gap_us[i] = hop - before;
    before = hop;
  }
}

void get_head(ByteReader& in, RawPose& raw, PoseHead& head) {
  const unsigned marks = in.u8();
  ++head.sequence;
  if ((marks & kSequenceMark) != 0) head.sequence += static_cast<std::uint32_t>(get_difference(in));
  if ((marks & kClockMark) != 0) head.clock_id += get_difference(in);
  raw.pose.sequence = head.sequence;
  raw.pose.clock_id = head.clock_id;

  head.step_us += get_difference(in);
  head.capture_time_us += head.step_us;
  raw.capture_time_us = signed_of(head.capture_time_us);

  std::uint64_t before = head.capture_time_us;
  for (std::size_t i = 0; i < kHopCount; ++i) {
    raw.hop_time_us[i] = 0;
    if ((marks & kHopMarks & (1u << i)) == 0) continue;
    head.gap_us[i] += get_difference(in);
    before += head.gap_us[i];
    raw.hop_time_us[i] = signed_of(before);
  }
}

}  // namespace

void PoseStreamPacker::restart() {
  encoder_.restart();
  head_ = {};
  is_at_key_ = true;
}

std::size_t PoseStreamPacker::pack(const RawPose& raw, std::span<std::uint8_t> out) {
  ByteWriter writer(out);
  put_head(writer, raw, head_);
  const std::size_t frame = writer.ok() ? encoder_.encode(raw.pose, out.subspan(writer.size())) : 0;
  if (frame == 0) {
    restart();
    return 0;
  }
  is_at_key_ = false;
  return writer.size() + frame;
}

void PoseStreamUnpacker::restart() {
  decoder_.restart();
  head_ = {};
}

DecodeResult PoseStreamUnpacker::unpack(bool is_key, std::span<const std::uint8_t> packed,
                                        RawPose& raw) {
  PoseHead head = is_key ? PoseHead() : head_;
  ByteReader reader(packed);
  get_head(reader, raw, head);
  const auto frame = reader.bytes(reader.remaining());
  if (frame.empty()) return DecodeResult::kMalformed;
  // A frame begins with 0x80 where it is a key frame.
  if (((frame[0] & 0x80) != 0) != is_key) return DecodeResult::kMalformed;
  const DecodeResult result = decoder_.decode(frame, raw.pose);
  if (result == DecodeResult::kPose) head_ = head;
  return result;
}

}  // namespace dance
