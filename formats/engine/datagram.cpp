#include "formats/engine/datagram.h"

#include <cstring>

#include "formats/engine/segment.h"

namespace dance::engine {
namespace {

constexpr std::uint64_t kDatagramMagic = 0x4b434142434e4144;  // "DANCBACK"
constexpr std::uint32_t kDatagramVersion = 1;
enum class Kind : std::uint32_t { kPose = 1, kHands = 2, kSkeleton = 3 };

template <class Datagram>
std::span<const std::uint8_t> put(Datagram& datagram, Kind kind, std::uint64_t session,
                                  DatagramBuffer& buffer) {
  datagram.head = {kDatagramMagic, kDatagramVersion, static_cast<std::uint32_t>(kind), session};
  std::memcpy(buffer.data(), &datagram, sizeof datagram);
  return {buffer.data(), sizeof datagram};
}

template <std::size_t kCount>
void put_rotations(const std::array<Eigen::Quaternionf, kCount>& from, float (&to)[kCount][4]) {
  for (std::size_t b = 0; b < kCount; ++b) Eigen::Vector4f::Map(to[b]) = from[b].coeffs();
}

template <std::size_t kCount>
void take_rotations(const float (&from)[kCount][4], std::array<Eigen::Quaternionf, kCount>& to) {
  for (std::size_t b = 0; b < kCount; ++b) to[b].coeffs() = Eigen::Vector4f(from[b]);
}

using What = decltype(Received::what);

What take(const PoseDatagram& datagram) {
  Pose pose;
  take_rotations(datagram.rotation_xyzw, pose.R_PB);
  pose.p_WH_m = Eigen::Vector3f(datagram.hips_m);
  pose.presence = datagram.presence;
  pose.confidence = datagram.confidence;
  if (!is_time(datagram.capture_ns) || (pose.presence & ~kAllBones) != 0 || !dance::is_valid(pose))
    return Fault::kInvalid;
  pose.capture_time = MonoTime::from_ns(datagram.capture_ns);
  normalize(pose);
  return pose;
}

What take(const HandsDatagram& datagram) {
  Hands hands;
  take_rotations(datagram.rotation_xyzw, hands.R_PB);
  hands.presence = datagram.presence;
  if (!is_time(datagram.capture_ns) || (hands.presence & ~kAllFingers) != 0 ||
      !dance::is_valid(hands))
    return Fault::kInvalid;
  hands.capture_time = MonoTime::from_ns(datagram.capture_ns);
  normalize(hands);
  return hands;
}

What take(const SkeletonDatagram& datagram) {
  Skeleton skeleton;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    skeleton.offset_m[b] = Eigen::Vector3f(datagram.offset_m[b]);
  for (std::size_t t = 0; t < kTipCount; ++t)
    skeleton.tip_m[t] = Eigen::Vector3f(datagram.tip_m[t]);
  if (!dance::is_valid(skeleton)) return Fault::kInvalid;
  return skeleton;
}

template <class Datagram>
What take_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != sizeof(Datagram)) return Fault::kWrongSize;
  Datagram datagram;
  std::memcpy(&datagram, bytes.data(), sizeof datagram);
  return take(datagram);
}

}  // namespace

std::span<const std::uint8_t> encode(std::uint64_t session, const Pose& pose,
                                     DatagramBuffer& buffer) {
  PoseDatagram datagram{};
  put_rotations(pose.R_PB, datagram.rotation_xyzw);
  Eigen::Vector3f::Map(datagram.hips_m) = pose.p_WH_m;
  datagram.presence = pose.presence;
  datagram.confidence = pose.confidence;
  datagram.capture_ns = pose.capture_time.since_zero_ns();
  return put(datagram, Kind::kPose, session, buffer);
}

std::span<const std::uint8_t> encode(std::uint64_t session, const Hands& hands,
                                     DatagramBuffer& buffer) {
  HandsDatagram datagram{};
  put_rotations(hands.R_PB, datagram.rotation_xyzw);
  datagram.presence = hands.presence;
  datagram.capture_ns = hands.capture_time.since_zero_ns();
  return put(datagram, Kind::kHands, session, buffer);
}

std::span<const std::uint8_t> encode(std::uint64_t session, const Skeleton& skeleton,
                                     DatagramBuffer& buffer) {
  SkeletonDatagram datagram{};
  for (std::size_t b = 0; b < kBoneCount; ++b)
    Eigen::Vector3f::Map(datagram.offset_m[b]) = skeleton.offset_m[b];
  for (std::size_t t = 0; t < kTipCount; ++t)
    Eigen::Vector3f::Map(datagram.tip_m[t]) = skeleton.tip_m[t];
  return put(datagram, Kind::kSkeleton, session, buffer);
}

Received decode(std::span<const std::uint8_t> bytes) {
  Received received;
  DatagramHead head{};
  if (bytes.size() < sizeof head) return received;
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.magic != kDatagramMagic) return received;
  received.session = head.session;
  received.what = Fault::kOtherVersion;
  if (head.version != kDatagramVersion) return received;
  switch (static_cast<Kind>(head.kind)) {
    case Kind::kPose:
      received.what = take_bytes<PoseDatagram>(bytes);
      break;
    case Kind::kHands:
      received.what = take_bytes<HandsDatagram>(bytes);
      break;
    case Kind::kSkeleton:
      received.what = take_bytes<SkeletonDatagram>(bytes);
      break;
    default:
      received.what = Fault::kInvalid;
  }
  return received;
}

}  // namespace dance::engine
