#include "formats/log/log_packer.h"

#include <algorithm>
#include <cstring>

#include "core/base/byte_writer.h"
#include "core/bus/channel.h"

namespace dance {
namespace {

constexpr std::string_view kWrappedChannel = "PACKED/as-it-was";

void put_opening(ByteWriter& out, PackedKind kind) {
  out.bytes(kPackedMagic);
  out.u8(kPackedVersion);
  out.u8(static_cast<std::uint8_t>(kind));
}

PackedKind kind_of(MotionType type, bool is_key) {
  if (type == MotionType::kPose) return is_key ? PackedKind::kPoseIntraFrame : PackedKind::kPose;
  return is_key ? PackedKind::kHandsIntraFrame : PackedKind::kHands;
}

}  // namespace

LogEvent LogPacker::pack(const LogEvent& event) {
  const LogEvent stored = is_packed(event) ? keep_as_it_was(event) : pack_motion(event);
  counters_.plain_bytes += event.stored_bytes();
  counters_.bytes += stored.stored_bytes();
  return stored;
}

// A packed log is played onto the bus: unpacking shall restore what was on the bus.
LogEvent LogPacker::keep_as_it_was(const LogEvent& event) {
  constexpr std::size_t kOpening_bytes = 6;
  wrapped_.resize(kOpening_bytes + event.channel.size() + event.data.size());
  ByteWriter out(wrapped_);
  put_opening(out, PackedKind::kAsItWas);
  out.short_text(event.channel);
  out.bytes(event.data);
  return {event.number, event.time_us, kWrappedChannel, wrapped_};
}

LogEvent LogPacker::pack_motion(const LogEvent& event) {
  if (!decode_unchecked(event.data.data(), event.data.size(), motion_)) return event;
  if (kPackedPrefix.size() + event.channel.size() > kMaxChannelLength) {
    ++counters_.kept;
    return event;
  }
  Stream& stream = stream_of(event.channel, motion_.type);
  // Modulo 2^64, so that a clock that was set back gives an intra frame, too.
  const std::uint64_t since_key_us =
      static_cast<std::uint64_t>(event.time_us) - static_cast<std::uint64_t>(stream.key_time_us);
  if (since_key_us >= static_cast<std::uint64_t>(intra_frame_period_.count_us()))
    stream.packer.restart();
  const bool is_key = stream.packer.is_at_key();
  if (is_key) stream.key_time_us = event.time_us;

  ByteWriter out(packed_);
  put_opening(out, kind_of(motion_.type, is_key));
  out.u32(checksum_of(event.channel, event.data));
  const std::size_t opening = out.size();
  const std::size_t size = stream.packer.pack(motion_, std::span(packed_).subspan(opening));
  const LogEvent stored{
      event.number, event.time_us, stream.channel, {packed_.data(), opening + size}};
  if (size == 0 || stored.stored_bytes() >= event.stored_bytes() ||
      !comes_back(stream, is_key, {packed_.data() + opening, size}, event)) {
    stream.packer.restart();
    ++counters_.kept;
    return event;
  }
  ++counters_.packed;
  if (is_key) ++counters_.intra_frames;
  return stored;
}

bool LogPacker::comes_back(Stream& stream, bool is_key, std::span<const std::uint8_t> packed,
                           const LogEvent& event) {
  if (stream.unpacker.unpack(is_key, packed, motion_) != DecodeResult::kPose) return false;
  MessageBuffer again;
  const std::size_t size = encode(motion_, again);
  return size == event.data.size() && std::memcmp(again.data(), event.data.data(), size) == 0;
}

LogPacker::Stream& LogPacker::stream_of(std::string_view channel, MotionType type) {
  auto found = streams_.find(channel);
  if (found != streams_.end() && found->second->packer.type() != type) {
    streams_.erase(found);
    found = streams_.end();
  }
  if (found == streams_.end()) {
    if (streams_.size() == kMaxMotionStreams)
      streams_.erase(std::min_element(
          streams_.begin(), streams_.end(),
          [](const auto& a, const auto& b) { return a.second->last_used < b.second->last_used; }));
    found = streams_.emplace(channel, std::make_unique<Stream>(type)).first;
    found->second->channel = kPackedPrefix;
    found->second->channel += channel;
  }
  found->second->last_used = ++uses_;
  return *found->second;
}

}  // namespace dance
