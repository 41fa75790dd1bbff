#include "core/codec/plain_codec.h"

#include <cmath>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/codec/packed_rotation.h"

namespace dance {
namespace {

constexpr std::uint8_t kHasMusic = 1;
constexpr std::uint8_t kWhole = 2;  // every bone measured and carried: no masks follow
constexpr double kTenthMillimetres = 10'000.0;

bool is_rest(const Eigen::Quaternionf& q) {
  return q.x() == 0.0f && q.y() == 0.0f && q.z() == 0.0f;
}

// The rotations to send: the measured ones, and those filled in with anything but the rest.
std::uint32_t carried_mask(const BoneRotations& rotations, std::uint32_t presence) {
  std::uint32_t carried = presence;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (!is_rest(rotations[i])) carried |= 1u << i;
  return carried;
}

void write_rotations(const BoneRotations& rotations, std::uint32_t carried, ByteWriter& out) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if ((carried >> i & 1u) != 0) out.u48(pack_rotation(rotations[i]));
}

bool read_rotations(ByteReader& in, std::uint32_t carried, BoneRotations& rotations) {
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    rotations[i] = Eigen::Quaternionf::Identity();
    if ((carried >> i & 1u) == 0) continue;
    const auto q = unpack_rotation(in.u48());
    if (!in.ok() || !q) return false;
    rotations[i] = *q;
  }
  return true;
}

}  // namespace

std::size_t PlainEncoder::encode(const Pose& pose, std::span<std::uint8_t> payload) {
  if (!is_valid(pose)) return 0;
  ByteWriter out(payload);
  const std::uint32_t presence = pose.presence & kAllBones;
  const std::uint32_t carried = carried_mask(pose.R_PB, presence);
  const bool has_music = std::isfinite(pose.music_beats);
  const bool whole = presence == kAllBones;
  out.u8(static_cast<std::uint8_t>((has_music ? kHasMusic : 0) | (whole ? kWhole : 0)));
  if (!whole) {
    out.u24(presence);
    out.u24(carried);
  }
  out.u8(static_cast<std::uint8_t>(std::lround(static_cast<double>(pose.confidence) * 255.0)));
  for (int axis = 0; axis < 3; ++axis)
    out.i32(static_cast<std::int32_t>(
        std::lround(static_cast<double>(pose.p_WH_m[axis]) * kTenthMillimetres)));
  if (has_music) out.f64(pose.music_beats);
  write_rotations(pose.R_PB, carried, out);
  return out.ok() ? out.size() : 0;
}

DecodeResult PlainDecoder::decode(std::uint32_t, std::span<const std::uint8_t> payload,
                                  Pose& pose) {
  ByteReader in(payload);
  const std::uint8_t flags = in.u8();
  if ((flags & ~(kHasMusic | kWhole)) != 0) return DecodeResult::kMalformed;
  std::uint32_t presence = kAllBones;
  std::uint32_t carried = kAllBones;
  if ((flags & kWhole) == 0) {
    presence = in.u24();
    carried = in.u24();
    if (((presence | carried) & ~kAllBones) != 0 || (presence & ~carried) != 0)
      return DecodeResult::kMalformed;
  }
  pose.presence = presence;
  pose.confidence = static_cast<float>(in.u8()) / 255.0f;
  for (int axis = 0; axis < 3; ++axis)
    pose.p_WH_m[axis] = static_cast<float>(in.i32() / kTenthMillimetres);
  pose.music_beats = (flags & kHasMusic) != 0 ? in.f64() : kNoMusic;
  if (!read_rotations(in, carried, pose.R_PB) || !in.is_exhausted())
    return DecodeResult::kMalformed;
  if ((flags & kHasMusic) != 0 && !std::isfinite(pose.music_beats)) return DecodeResult::kMalformed;
  return is_valid(pose) ? DecodeResult::kPose : DecodeResult::kMalformed;
}

std::size_t encode_skeleton(const Skeleton& skeleton, std::span<std::uint8_t> payload) {
  if (!is_valid(skeleton)) return 0;
  ByteWriter out(payload);
  out.u32(skeleton.version);
  const auto write = [&out](const Eigen::Vector3f& v) {
    for (int axis = 0; axis < 3; ++axis)
      out.i16(
          static_cast<std::int16_t>(std::lround(static_cast<double>(v[axis]) * kTenthMillimetres)));
  };
  for (const auto& offset : skeleton.offset_m) write(offset);
  for (const auto& tip : skeleton.tip_m) write(tip);
  return out.ok() ? out.size() : 0;
}

bool decode_skeleton(std::span<const std::uint8_t> payload, Skeleton& skeleton) {
  ByteReader in(payload);
  skeleton.version = in.u32();
  const auto read = [&in] {
    Eigen::Vector3f v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(in.i16() / kTenthMillimetres);
    return v;
  };
  for (auto& offset : skeleton.offset_m) offset = read();
  for (auto& tip : skeleton.tip_m) tip = read();
  return in.is_exhausted() && is_valid(skeleton);
}

}  // namespace dance
