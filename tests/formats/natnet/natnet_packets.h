// Writes the packets of a NatNet server, for tests.
//
// Units/frames: as formats/natnet/natnet_packet.h.
// Ownership:    returns values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/natnet/natnet_packet.h"

namespace dance {

class NatNetPacketWriter {
 public:
  NatNetPacketWriter& u8(unsigned value) {
    bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  NatNetPacketWriter& u16(unsigned value) { return u8(value & 0xffu).u8(value >> 8 & 0xffu); }
  NatNetPacketWriter& u32(std::uint32_t value) { return u16(value & 0xffffu).u16(value >> 16); }
  NatNetPacketWriter& u64(std::uint64_t value) {
    return u32(static_cast<std::uint32_t>(value)).u32(static_cast<std::uint32_t>(value >> 32));
  }
  NatNetPacketWriter& f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
  NatNetPacketWriter& f64(double value) { return u64(std::bit_cast<std::uint64_t>(value)); }
  NatNetPacketWriter& text(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return u8(0);
  }
  NatNetPacketWriter& vector(const Eigen::Vector3f& v) { return f32(v.x()).f32(v.y()).f32(v.z()); }
  NatNetPacketWriter& append(const NatNetPacketWriter& other) {
    bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
    return *this;
  }
  // A section: how many pieces, and from 4.1 on how many bytes.
  NatNetPacketWriter& section(NatNetVersion version, std::uint32_t count,
                              const NatNetPacketWriter& content) {
    u32(count);
    if (version >= NatNetVersion{4, 1}) u32(static_cast<std::uint32_t>(content.bytes_.size()));
    return append(content);
  }
  std::vector<std::uint8_t> packet(NatNetMessage message) const {
    NatNetPacketWriter whole;
    whole.u16(static_cast<unsigned>(message)).u16(static_cast<unsigned>(bytes_.size()));
    return whole.append(*this).bytes_;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

inline std::vector<std::uint8_t> natnet_server_packet(NatNetVersion version,
                                                      std::uint64_t ticks_per_second = 0) {
  NatNetPacketWriter body;
  body.text("Motive");
  for (std::size_t i = 7; i < 256; ++i) body.u8(0);
  body.u32(0x0103).u8(version.major).u8(version.minor).u16(0);
  if (ticks_per_second > 0) body.u64(ticks_per_second).u16(1511).u8(1).u32(0x632affef);
  return body.packet(NatNetMessage::kServerInfo);
}

inline NatNetPacketWriter natnet_bone_description(NatNetVersion version,
                                                  const NatNetModelBone& bone,
                                                  std::uint32_t markers) {
  NatNetPacketWriter body;
  body.text(std::string(bone.name.view()));
  body.u32(static_cast<std::uint32_t>(bone.id)).u32(static_cast<std::uint32_t>(bone.parent_id));
  body.vector(bone.offset_m).u32(markers);
  for (std::uint32_t m = 0; m < markers; ++m) body.vector({0.1f, 0.2f, 0.3f});
  for (std::uint32_t m = 0; m < markers; ++m) body.u32(m);
  if (version >= NatNetVersion{4, 0})
    for (std::uint32_t m = 0; m < markers; ++m) body.text("marker" + std::to_string(m));
  return body;
}

// A set of markers and a rigid body, then the skeletons.
inline std::vector<std::uint8_t> natnet_models_packet(NatNetVersion version,
                                                      const NatNetModels& models) {
  const bool has_sizes = version >= NatNetVersion{4, 1};
  NatNetPacketWriter body;
  const auto add = [&](std::uint32_t kind, const NatNetPacketWriter& content) {
    body.u32(kind);
    if (has_sizes) body.u32(static_cast<std::uint32_t>(content.packet({}).size() - 4));
    body.append(content);
  };
  body.u32(static_cast<std::uint32_t>(2 + models.skeletons.size()));
  add(0, NatNetPacketWriter().text("all").u32(2).text("a").text("b"));
  NatNetModelBone hat;
  (void)hat.name.assign("Hat");
  add(1, natnet_bone_description(version, hat, 3));
  for (const NatNetModel& model : models.skeletons) {
    NatNetPacketWriter skeleton;
    skeleton.text(std::string(model.name.view())).u32(static_cast<std::uint32_t>(model.id));
    skeleton.u32(static_cast<std::uint32_t>(model.bones.size()));
    for (const NatNetModelBone& bone : model.bones)
      skeleton.append(natnet_bone_description(version, bone, 2));
    add(2, skeleton);
  }
  return body.packet(NatNetMessage::kModels);
}

inline NatNetPacketWriter natnet_rigid_body(std::uint32_t id, const NatNetBone& bone) {
  NatNetPacketWriter body;
  body.u32(id).vector(bone.p_m);
  body.f32(bone.R.x()).f32(bone.R.y()).f32(bone.R.z()).f32(bone.R.w());
  return body.f32(0.0002f).u16(bone.is_tracked ? 1 : 0);
}

// With markers, a rigid body, and from 4.1 on an asset around the skeletons.
inline std::vector<std::uint8_t> natnet_frame_packet(NatNetVersion version,
                                                     const NatNetFrame& frame) {
  NatNetPacketWriter body;
  body.u32(frame.number);
  NatNetPacketWriter sets;
  sets.text("all").u32(2).vector({1, 2, 3}).vector({4, 5, 6});
  body.section(version, 1, sets);
  body.section(version, 1, NatNetPacketWriter().vector({7, 8, 9}));
  NatNetPacketWriter bodies;
  for (std::uint32_t i = 0; i < frame.rigid_bodies; ++i)
    bodies.append(natnet_rigid_body(i + 1, NatNetBone()));
  body.section(version, frame.rigid_bodies, bodies);
  NatNetPacketWriter skeletons;
  for (const NatNetSkeleton& skeleton : frame.skeletons) {
    const auto id = static_cast<std::uint32_t>(skeleton.id);
    skeletons.u32(id).u32(static_cast<std::uint32_t>(skeleton.bones.size()));
    for (const NatNetBone& bone : skeleton.bones)
      skeletons.append(natnet_rigid_body(id << 16 | static_cast<std::uint32_t>(bone.id), bone));
  }
  body.section(version, static_cast<std::uint32_t>(frame.skeletons.size()), skeletons);
  if (version >= NatNetVersion{4, 1})
    body.section(version, 1, NatNetPacketWriter().u32(1).u32(0).u32(0));
  NatNetPacketWriter markers;
  markers.u32(1).vector({1, 2, 3}).f32(0.01f).u16(2).f32(0.1f);
  body.section(version, 1, markers);
  NatNetPacketWriter plate;
  plate.u32(1).u32(2).u32(1).f32(5.0f).u32(2).f32(6.0f).f32(7.0f);
  body.section(version, 1, plate);
  body.section(version, 0, NatNetPacketWriter());
  body.u32(0).u32(0).f64(frame.timestamp_s);
  body.u64(frame.exposed_ticks).u64(frame.exposed_ticks + 10).u64(frame.exposed_ticks + 20);
  if (version >= NatNetVersion{4, 1}) body.u32(1'700'000'001).u32(0x80000000);
  body.u16(frame.models_changed ? 2 : 0).u32(0);
  return body.packet(NatNetMessage::kFrame);
}

}  // namespace dance
