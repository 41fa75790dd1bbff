#include "formats/natnet/natnet_packet.h"

#include <cmath>

#include "core/base/byte_reader.h"

namespace dance {
namespace {

constexpr std::size_t kHeader_bytes = 4;
constexpr std::size_t kLongestText = 255;

// From these versions on.
constexpr NatNetVersion kWithSizes{4, 1};  // of sections
constexpr NatNetVersion kWithPreciseTime{4, 1};

class Packet {
 public:
  Packet(std::span<const std::uint8_t> bytes, NatNetVersion version)
      : reader_(bytes), version_(version) {}

  ByteReader& reader() { return reader_; }
  bool has_sizes() const { return version_ >= kWithSizes; }
  bool has_precise_time() const { return version_ >= kWithPreciseTime; }
  Eigen::Vector3f vector() {
    const float x = reader_.f32(), y = reader_.f32(), z = reader_.f32();
    return {x, y, z};
  }
  // Skips `count` pieces of at least so many bytes; false where they cannot be there.
  bool skip(std::uint32_t count, std::size_t bytes_each) {
    if (count > reader_.remaining() / bytes_each) return false;
    reader_.bytes(count * bytes_each);
    return reader_.ok();
  }
  bool skip_texts(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count && reader_.ok(); ++i) reader_.text_to_zero(kLongestText);
    return reader_.ok();
  }
  // How many pieces a section has, and from 4.1 on how many bytes, which then skip it whole where
  // `skips`; nullopt where it is cut short.
  std::optional<std::uint32_t> section(bool skips) {
    const std::uint32_t count = reader_.u32();
    if (has_sizes()) {
      const std::uint32_t size = reader_.u32();
      if (size > reader_.remaining()) return std::nullopt;
      if (skips) {
        reader_.bytes(size);
        return reader_.ok() ? std::optional(0u) : std::nullopt;
      }
    }
    return reader_.ok() ? std::optional(count) : std::nullopt;
  }

 private:
  ByteReader reader_;
  NatNetVersion version_;
};

bool skip_marker_sets(Packet& packet) {
  const auto sets = packet.section(true);
  if (!sets) return false;
  for (std::uint32_t i = 0; i < *sets; ++i) {
    packet.reader().text_to_zero(kLongestText);
    if (!packet.skip(packet.reader().u32(), 12)) return false;
  }
  return true;
}

constexpr std::size_t kRigidBody_bytes = 38;  // id, place, rotation, mean error, parameters
constexpr std::size_t kMarker_bytes = 26;     // id, place, size, parameters, residual

// Channels of numbers, of force plates and devices.
bool skip_devices(Packet& packet) {
  const auto devices = packet.section(true);
  if (!devices) return false;
  for (std::uint32_t i = 0; i < *devices; ++i) {
    packet.reader().u32();
    const std::uint32_t channels = packet.reader().u32();
    for (std::uint32_t c = 0; c < channels && packet.reader().ok(); ++c)
      if (!packet.skip(packet.reader().u32(), 4)) return false;
    if (!packet.reader().ok()) return false;
  }
  return true;
}

NatNetBone read_bone(Packet& packet) {
  NatNetBone bone;
  ByteReader& reader = packet.reader();
  // The skeleton's number is in the upper half.
  bone.id = static_cast<std::int32_t>(reader.u32() & 0xffffu);
  bone.p_m = packet.vector();
  const float x = reader.f32(), y = reader.f32(), z = reader.f32(), w = reader.f32();
  reader.f32();
  const bool says_tracked = (reader.u16() & 1u) != 0;
  const Eigen::Quaternionf R(w, x, y, z);
  const float norm = R.squaredNorm();
  constexpr float kFarthest_m = 1000.0f;
  bone.is_tracked = says_tracked && bone.p_m.allFinite() &&
                    bone.p_m.cwiseAbs().maxCoeff() < kFarthest_m && norm > 0.98f && norm < 1.02f;
  if (bone.is_tracked)
    bone.R = R.normalized();
  else
    bone.p_m.setZero();
  return bone;
}

NatNetFault read_skeletons(Packet& packet, NatNetFrame& frame) {
  const auto skeletons = packet.section(false);
  if (!skeletons) return NatNetFault::kTooShort;
  if (*skeletons > kMostNatNetSkeletons) return NatNetFault::kTooMany;
  for (std::uint32_t i = 0; i < *skeletons; ++i) {
    if (!frame.skeletons.try_push({})) return NatNetFault::kTooMany;
    NatNetSkeleton& skeleton = frame.skeletons[i];
    skeleton.id = packet.reader().i32();
    const std::uint32_t bones = packet.reader().u32();
    if (!packet.reader().ok()) return NatNetFault::kTooShort;
    if (bones > kMostNatNetBones) return NatNetFault::kTooMany;
    skeleton.bones.clear();
    for (std::uint32_t b = 0; b < bones; ++b)
      if (!skeleton.bones.try_push(read_bone(packet))) return NatNetFault::kTooMany;
    if (!packet.reader().ok()) return NatNetFault::kTooShort;
  }
  return NatNetFault::kNone;
}

NatNetFault read_end(Packet& packet, NatNetFrame& frame) {
  ByteReader& reader = packet.reader();
  reader.u32();  // timecode
  reader.u32();
  frame.timestamp_s = reader.f64();
  frame.exposed_ticks = reader.u64();
  reader.u64();  // received by the server
  reader.u64();  // sent by it
  if (packet.has_precise_time()) {
    reader.u32();  // seconds
    reader.u32();  // fraction
  }
  frame.models_changed = (reader.u16() & 2u) != 0;
  if (!reader.ok()) return NatNetFault::kTooShort;
  if (!std::isfinite(frame.timestamp_s) || std::abs(frame.timestamp_s) > 1e12)
    frame.timestamp_s = 0.0;
  return NatNetFault::kNone;
}

// Of a rigid body, alone or in a skeleton.
NatNetFault read_model_bone(Packet& packet, NatNetVersion version, NatNetModelBone& bone) {
  ByteReader& reader = packet.reader();
  const std::string_view name = reader.text_to_zero(kLongestText);
  bone.id = static_cast<std::int32_t>(reader.u32() & 0xffffu);
  bone.parent_id = static_cast<std::int32_t>(reader.u32() & 0xffffu);
  bone.offset_m = packet.vector();
  const std::uint32_t markers = reader.u32();
  if (!packet.skip(markers, 12) || !packet.skip(markers, 4)) return NatNetFault::kTooShort;
  if (version >= NatNetVersion{4, 0} && !packet.skip_texts(markers)) return NatNetFault::kTooShort;
  if (!reader.ok()) return NatNetFault::kTooShort;
  if (!bone.offset_m.allFinite()) bone.offset_m.setZero();
  return bone.name.assign(name) ? NatNetFault::kNone : NatNetFault::kBadName;
}

NatNetFault read_model(Packet& packet, NatNetVersion version, NatNetModels& models) {
  ByteReader& reader = packet.reader();
  if (!models.skeletons.try_push({})) return NatNetFault::kTooMany;
  NatNetModel& model = models.skeletons[models.skeletons.size() - 1];
  model.bones.clear();
  const std::string_view name = reader.text_to_zero(kLongestText);
  model.id = reader.i32();
  const std::uint32_t bones = reader.u32();
  if (!reader.ok()) return NatNetFault::kTooShort;
  if (!model.name.assign(name)) return NatNetFault::kBadName;
  if (bones > kMostNatNetBones) return NatNetFault::kTooMany;
  for (std::uint32_t b = 0; b < bones; ++b) {
    NatNetModelBone bone;
    if (const auto fault = read_model_bone(packet, version, bone); fault != NatNetFault::kNone)
      return fault;
    if (!model.bones.try_push(bone)) return NatNetFault::kTooMany;
  }
  return NatNetFault::kNone;
}

enum class ModelKind : std::uint32_t {
  kMarkerSet,
  kRigidBody,
  kSkeleton,
  kForcePlate,
  kDevice,
  kCamera,
};

bool skip_model(Packet& packet, NatNetVersion version, ModelKind kind) {
  ByteReader& reader = packet.reader();
  switch (kind) {
    case ModelKind::kMarkerSet:
      reader.text_to_zero(kLongestText);
      return packet.skip_texts(reader.u32());
    case ModelKind::kRigidBody: {
      NatNetModelBone bone;
      return read_model_bone(packet, version, bone) != NatNetFault::kTooShort;
    }
    case ModelKind::kForcePlate:
      reader.u32();
      reader.text_to_zero(kLongestText);
      // Width, length and origin, the calibration of 12 × 12, four corners, kind and kind of data.
      reader.bytes(4 * (2 + 3 + 144 + 12 + 2));
      return packet.skip_texts(reader.u32());
    case ModelKind::kDevice:
      reader.u32();
      packet.skip_texts(2);
      reader.bytes(8);
      return packet.skip_texts(reader.u32());
    case ModelKind::kCamera:
      reader.text_to_zero(kLongestText);
      reader.bytes(4 * 7);
      return reader.ok();
    default:
      return false;
  }
}

}  // namespace

const char* text_of(NatNetFault fault) {
  switch (fault) {
    case NatNetFault::kNone:
      return "read";
    case NatNetFault::kTooShort:
      return "cut short";
    case NatNetFault::kOtherMessage:
      return "of no use";
    case NatNetFault::kOtherVersion:
      return "of a version that is not 3.0 to 4.1";
    case NatNetFault::kTooMany:
      return "with too many skeletons or bones";
    case NatNetFault::kBadName:
      return "with an unusable name";
  }
  return "";
}

std::optional<NatNetVersion> parse_natnet_version(std::string_view text) {
  if (text.size() != 3 || text[1] != '.') return std::nullopt;
  if (text[0] < '0' || text[0] > '9' || text[2] < '0' || text[2] > '9') return std::nullopt;
  const NatNetVersion version{static_cast<std::uint8_t>(text[0] - '0'),
                              static_cast<std::uint8_t>(text[2] - '0')};
  return can_be_read(version) ? std::optional(version) : std::nullopt;
}

std::optional<NatNetMessage> message_of(std::span<const std::uint8_t> packet) {
  ByteReader reader(packet);
  const std::uint16_t message = reader.u16();
  const std::uint16_t size = reader.u16();
  if (!reader.ok() || size > reader.remaining()) return std::nullopt;
  return static_cast<NatNetMessage>(message);
}

NatNetFault read_natnet_server(std::span<const std::uint8_t> packet, NatNetServer& server) {
  if (message_of(packet) != NatNetMessage::kServerInfo) return NatNetFault::kOtherMessage;
  ByteReader reader(packet.subspan(kHeader_bytes));
  reader.bytes(256);  // the program's name
  reader.u32();       // and version
  server.version.major = reader.u8();
  server.version.minor = reader.u8();
  reader.u16();
  if (!reader.ok()) return NatNetFault::kTooShort;
  server.ticks_per_second = reader.u64();
  if (!reader.ok()) server.ticks_per_second = 0;
  return can_be_read(server.version) ? NatNetFault::kNone : NatNetFault::kOtherVersion;
}

NatNetFault read_natnet_models(std::span<const std::uint8_t> bytes, NatNetVersion version,
                               NatNetModels& models) {
  models.skeletons.clear();
  models.others = 0;
  if (message_of(bytes) != NatNetMessage::kModels) return NatNetFault::kOtherMessage;
  if (!can_be_read(version)) return NatNetFault::kOtherVersion;
  Packet packet(bytes.subspan(kHeader_bytes), version);
  ByteReader& reader = packet.reader();
  const std::uint32_t sets = reader.u32();
  for (std::uint32_t i = 0; i < sets; ++i) {
    const auto kind = static_cast<ModelKind>(reader.u32());
    const std::uint32_t size = packet.has_sizes() ? reader.u32() : 0;
    if (!reader.ok() || size > reader.remaining()) return NatNetFault::kTooShort;
    if (kind == ModelKind::kSkeleton) {
      const std::size_t before = reader.remaining();
      if (const auto fault = read_model(packet, version, models); fault != NatNetFault::kNone)
        return fault;
      if (packet.has_sizes() && before - reader.remaining() != size) return NatNetFault::kTooShort;
      continue;
    }
    ++models.others;
    if (packet.has_sizes()) {
      reader.bytes(size);
      continue;
    }
    if (!skip_model(packet, version, kind)) return NatNetFault::kTooShort;
  }
  return reader.ok() ? NatNetFault::kNone : NatNetFault::kTooShort;
}

NatNetFault read_natnet_frame(std::span<const std::uint8_t> bytes, NatNetVersion version,
                              NatNetFrame& frame) {
  frame.skeletons.clear();
  frame.rigid_bodies = 0;
  if (message_of(bytes) != NatNetMessage::kFrame) return NatNetFault::kOtherMessage;
  if (!can_be_read(version)) return NatNetFault::kOtherVersion;
  Packet packet(bytes.subspan(kHeader_bytes), version);
  frame.number = packet.reader().u32();
  if (!skip_marker_sets(packet)) return NatNetFault::kTooShort;
  const auto unlabelled = packet.section(false);
  if (!unlabelled || !packet.skip(*unlabelled, 12)) return NatNetFault::kTooShort;
  const auto bodies = packet.section(false);
  if (!bodies || !packet.skip(*bodies, kRigidBody_bytes)) return NatNetFault::kTooShort;
  frame.rigid_bodies = *bodies;
  if (const auto fault = read_skeletons(packet, frame); fault != NatNetFault::kNone) return fault;
  if (packet.has_sizes() && !packet.section(true)) return NatNetFault::kTooShort;  // assets
  const auto labelled = packet.section(false);
  if (!labelled || !packet.skip(*labelled, kMarker_bytes)) return NatNetFault::kTooShort;
  if (!skip_devices(packet) || !skip_devices(packet)) return NatNetFault::kTooShort;
  return read_end(packet, frame);
}

FixedList<std::uint8_t, 64> natnet_request(NatNetMessage message, std::string_view text) {
  FixedList<std::uint8_t, 64> bytes;
  const auto push = [&bytes](unsigned value) {
    DANCE_ASSERT(bytes.try_push(static_cast<std::uint8_t>(value)));
  };
  const auto id = static_cast<unsigned>(message);
  const auto size = static_cast<unsigned>(text.size() + 1);
  for (const unsigned value : {id & 0xffu, id >> 8, size & 0xffu, size >> 8}) push(value);
  for (const char c : text) push(static_cast<unsigned char>(c));
  push(0);
  return bytes;
}

}  // namespace dance
