#include "formats/log/log_unpacker.h"

#include <algorithm>

namespace dance {

std::optional<LogEvent> LogUnpacker::unpack(const LogEvent& event) {
  if (!is_packed(event)) return event;
  ByteReader body(event.data.subspan(kPackedMagic.size()));
  if (body.u8() != kPackedVersion) {
    ++counters_.newer;
    return std::nullopt;
  }
  const std::uint8_t kind = body.u8();
  switch (static_cast<PackedKind>(kind)) {
    case PackedKind::kPoseIntraFrame:
      return unpack_motion(event, MotionType::kPose, true, body);
    case PackedKind::kPose:
      return unpack_motion(event, MotionType::kPose, false, body);
    case PackedKind::kHandsIntraFrame:
      return unpack_motion(event, MotionType::kHands, true, body);
    case PackedKind::kHands:
      return unpack_motion(event, MotionType::kHands, false, body);
    case PackedKind::kAsItWas: {
      const std::string_view channel = body.text(body.u8());
      const auto data = body.bytes(body.remaining());
      const LogEvent inner{event.number, event.time_us, channel, data};
      if (body.ok() && is_packed(inner)) return inner;  // the only use of wrapping
      break;
    }
  }
  ++counters_.damaged;
  return std::nullopt;
}

std::optional<LogEvent> LogUnpacker::unpack_motion(const LogEvent& event, MotionType type,
                                                   bool is_key, ByteReader body) {
  const std::string_view channel = event.channel.substr(kPackedPrefix.size());
  const std::uint32_t checksum = body.u32();
  const auto packed = body.bytes(body.remaining());
  if (!body.ok() || channel.empty()) {
    ++counters_.damaged;
    return std::nullopt;
  }
  Stream* stream = stream_of(channel, type, is_key);
  const DecodeResult result =
      stream ? stream->unpacker.unpack(is_key, packed, motion_) : DecodeResult::kReferenceMissing;
  if (result == DecodeResult::kReferenceMissing) {
    ++counters_.orphaned;
    return std::nullopt;
  }
  if (result == DecodeResult::kPose) {
    const std::size_t size = encode(motion_, message_);
    const LogEvent plain{event.number, event.time_us, channel, {message_.data(), size}};
    if (checksum_of(channel, plain.data) == checksum) {
      ++counters_.unpacked;
      return plain;
    }
    stream->unpacker.restart();
  }
  ++counters_.damaged;
  return std::nullopt;
}

// Only an intra frame begins a stream, so a damaged name costs no memory.
LogUnpacker::Stream* LogUnpacker::stream_of(std::string_view channel, MotionType type,
                                            bool is_key) {
  auto found = streams_.find(channel);
  const bool is_known = found != streams_.end() && found->second->unpacker.type() == type;
  if (!is_known) {
    if (!is_key) return nullptr;
    if (found != streams_.end()) streams_.erase(found);
    if (streams_.size() == kMaxMotionStreams)
      streams_.erase(std::min_element(
          streams_.begin(), streams_.end(),
          [](const auto& a, const auto& b) { return a.second->last_used < b.second->last_used; }));
    found = streams_.emplace(channel, std::make_unique<Stream>(type)).first;
  }
  found->second->last_used = ++uses_;
  return found->second.get();
}

}  // namespace dance
