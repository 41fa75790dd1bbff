#include "formats/log/motion_stream.h"

#include "core/base/assert.h"
#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"

namespace dance {
namespace {

constexpr unsigned kHopMarks = (1u << kHopCount) - 1;
constexpr unsigned kSequenceMark = 1u << 6;
constexpr unsigned kClockMark = 1u << 7;
static_assert(kHopCount == 6);
constexpr std::size_t kHandBones = kFingerBoneCount / 2;
constexpr std::uint32_t kHandPresence = (1u << kHandBones) - 1;
static_assert(kHandBones <= kBoneCount);

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

void put_head(ByteWriter& out, const RawPose& raw, MotionHead& head) {
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

void get_head(ByteReader& in, RawPose& raw, MotionHead& head) {
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

std::size_t encode(const RawMotion& motion, MessageBuffer& buffer) {
  if (motion.type == MotionType::kPose) return encode(motion.pose, buffer);
  RawHands raw;
  const Pose& left = motion.pose.pose;
  for (std::size_t i = 0; i < kHandBones; ++i) {
    raw.hands.R_PB[i] = left.R_PB[i];
    raw.hands.R_PB[kHandBones + i] = motion.right_hand.R_PB[i];
  }
  raw.hands.presence = (left.presence & kHandPresence) | (motion.right_hand.presence << kHandBones);
  raw.hands.sequence = left.sequence;
  raw.hands.clock_id = left.clock_id;
  raw.capture_time_us = motion.pose.capture_time_us;
  return encode(raw, buffer);
}

bool decode_unchecked(const void* data, std::size_t size, RawMotion& motion) {
  motion.type = MotionType::kPose;
  if (decode_unchecked(data, size, motion.pose)) return true;
  RawHands raw;
  if (!decode_unchecked(data, size, raw)) return false;
  motion = {MotionType::kHands, {}, {}};
  Pose& left = motion.pose.pose;
  for (std::size_t i = 0; i < kHandBones; ++i) {
    left.R_PB[i] = raw.hands.R_PB[i];
    motion.right_hand.R_PB[i] = raw.hands.R_PB[kHandBones + i];
  }
  left.presence = raw.hands.presence & kHandPresence;
  motion.right_hand.presence = raw.hands.presence >> kHandBones;  // with unused bits
  left.sequence = raw.hands.sequence;
  left.clock_id = raw.hands.clock_id;
  motion.pose.capture_time_us = raw.capture_time_us;
  return true;
}

MotionPacker::MotionPacker(MotionType type) : type_(type) {
  if (type == MotionType::kHands) right_hand_.emplace();
}

void MotionPacker::restart() {
  encoder_.restart();
  if (right_hand_) right_hand_->restart();
  head_ = {};
  is_at_key_ = true;
}

std::size_t MotionPacker::pack(const RawMotion& motion, std::span<std::uint8_t> out) {
  DANCE_ASSERT(motion.type == type_);
  is_at_key_ = false;
  ByteWriter writer(out);
  put_head(writer, motion.pose, head_);
  if (writer.ok() && !right_hand_) {
    const std::size_t frame = encoder_.encode(motion.pose.pose, out.subspan(writer.size()));
    if (frame > 0) return writer.size() + frame;
  } else if (writer.ok()) {
    std::array<std::uint8_t, kMaxLosslessPayload> left;
    const std::size_t left_size = encoder_.encode(motion.pose.pose, left);
    writer.u16(static_cast<std::uint16_t>(left_size));
    writer.bytes({left.data(), left_size});
    const std::size_t right =
        left_size > 0 && writer.ok()
            ? right_hand_->encode(motion.right_hand, out.subspan(writer.size()))
            : 0;
    if (right > 0) return writer.size() + right;
  }
  restart();
  return 0;
}

MotionUnpacker::MotionUnpacker(MotionType type) : type_(type) {
  if (type == MotionType::kHands) right_hand_.emplace();
}

void MotionUnpacker::restart() {
  decoder_.restart();
  if (right_hand_) right_hand_->restart();
  head_ = {};
}

DecodeResult MotionUnpacker::unpack(bool is_key, std::span<const std::uint8_t> packed,
                                    RawMotion& motion) {
  motion.type = type_;
  MotionHead head = is_key ? MotionHead() : head_;
  ByteReader reader(packed);
  get_head(reader, motion.pose, head);
  const auto left = reader.bytes(right_hand_ ? reader.u16() : reader.remaining());
  const auto right = reader.bytes(reader.remaining());
  // An intra frame begins with 0x80.
  const auto is_frame = [is_key](std::span<const std::uint8_t> frame) {
    return !frame.empty() && ((frame[0] & 0x80) != 0) == is_key;
  };
  if (!is_frame(left) || (right_hand_ && !is_frame(right))) return DecodeResult::kMalformed;
  DecodeResult result = decoder_.decode(left, motion.pose.pose);
  if (result == DecodeResult::kPose && right_hand_) {
    result = right_hand_->decode(right, motion.right_hand);
    // The left hand has advanced, the right has not.
    if (result == DecodeResult::kReferenceMissing) result = DecodeResult::kMalformed;
    if (result != DecodeResult::kPose) restart();
  }
  if (result == DecodeResult::kPose) head_ = head;
  return result;
}

DecodeResult MotionGlance::look(bool is_key, std::span<const std::uint8_t> packed, RawPose& raw) {
  MotionHead head = is_key ? MotionHead() : head_;
  ByteReader reader(packed);
  get_head(reader, raw, head);
  const auto frame = reader.bytes(reader.remaining());
  if (frame.empty() || ((frame[0] & 0x80) != 0) != is_key) return DecodeResult::kMalformed;
  const DecodeResult result = body_.look(frame, raw.pose);
  if (result == DecodeResult::kPose) head_ = head;
  return result;
}

}  // namespace dance
