// The messages of NatNet, in which OptiTrack's Motive streams: what a server says of itself, which
// skeletons there are, and where their bones are in a frame. Versions 3.0 to 4.1.
//
// Units/frames: as sent: metres, right-handed, in the axes that are set in Motive; a bone's place
//               and rotation are global, or in its parent, by another setting there. Quaternions
//               are x, y, z, w on the wire.
// Ownership:    plain values; reading allocates nothing.
// Threads:      none inside.
// Failure:      read_…() of a damaged or foreign packet is a NatNetFault. No count is trusted
//               beyond the bytes that are there; skeletons and bones beyond the bounds are a fault.
//               Bones that are not finite are not tracked.
// Source:       the layout as public clients read it: libmotioncapture (IMRCLab,
//               src/optitrack.cpp), python_natnet (mje-nz), python-natnet-client (TimSchneider42),
//               natnet_py (jeguzzi), and as OptiTrack's own PacketClient does, which has the
//               precision timestamp of 4.1.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/fixed_list.h"
#include "core/base/fixed_string.h"

namespace dance {

enum class NatNetMessage : std::uint16_t {
  kConnect = 0,
  kServerInfo = 1,
  kRequest = 2,
  kResponse = 3,
  kRequestModels = 4,
  kModels = 5,
  kFrame = 7,
  kKeepAlive = 10,
};

struct NatNetVersion {
  std::uint8_t major = 0;
  std::uint8_t minor = 0;
  auto operator<=>(const NatNetVersion&) const = default;
};
constexpr NatNetVersion kOldestNatNet{3, 0};
constexpr NatNetVersion kNewestNatNet{4, 1};
// "3.1"; nullopt for what is none that can be read.
std::optional<NatNetVersion> parse_natnet_version(std::string_view text);
constexpr bool can_be_read(NatNetVersion version) {
  return version >= kOldestNatNet && version <= kNewestNatNet;
}

enum class NatNetFault : std::uint8_t {
  kNone,
  kTooShort,      // for what it says to hold
  kOtherMessage,  // one that is of no use here
  kOtherVersion,  // of the protocol
  kTooMany,       // skeletons or bones
  kBadName,       // of a skeleton or bone
};
constexpr std::size_t kNatNetFaultCount = 6;
const char* text_of(NatNetFault fault);

constexpr std::size_t kMostNatNetSkeletons = 16;
constexpr std::size_t kMostNatNetBones = 96;  // 21 of a body, 60 with the ends of fingers

struct NatNetServer {
  NatNetVersion version;
  std::uint64_t ticks_per_second = 0;  // of the stamps of frames; 0: not said
};

struct NatNetModelBone {
  FixedString<64> name;
  std::int32_t id = 0;
  std::int32_t parent_id = 0;  // 0: none
  Eigen::Vector3f offset_m = Eigen::Vector3f::Zero();
};
struct NatNetModel {
  FixedString<64> name;
  std::int32_t id = 0;
  FixedList<NatNetModelBone, kMostNatNetBones> bones;
};
struct NatNetModels {
  FixedList<NatNetModel, kMostNatNetSkeletons> skeletons;
  std::size_t others = 0;  // rigid bodies, sets of markers, devices
};

struct NatNetBone {
  std::int32_t id = 0;  // of the bone in its skeleton
  Eigen::Vector3f p_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf R = Eigen::Quaternionf::Identity();
  bool is_tracked = false;
};
struct NatNetSkeleton {
  std::int32_t id = 0;
  FixedList<NatNetBone, kMostNatNetBones> bones;
};
struct NatNetFrame {
  std::uint32_t number = 0;
  FixedList<NatNetSkeleton, kMostNatNetSkeletons> skeletons;
  std::uint32_t rigid_bodies = 0;
  double timestamp_s = 0.0;
  std::uint64_t exposed_ticks = 0;  // the middle of the cameras' exposure; 0: not said
  bool models_changed = false;
};

// The message of a packet, where it is as long as it says.
std::optional<NatNetMessage> message_of(std::span<const std::uint8_t> packet);
NatNetFault read_natnet_server(std::span<const std::uint8_t> packet, NatNetServer& server);
NatNetFault read_natnet_models(std::span<const std::uint8_t> packet, NatNetVersion version,
                               NatNetModels& models);
NatNetFault read_natnet_frame(std::span<const std::uint8_t> packet, NatNetVersion version,
                              NatNetFrame& frame);

// A request to a server, with a text or none: the bytes of it.
FixedList<std::uint8_t, 64> natnet_request(NatNetMessage message, std::string_view text);

}  // namespace dance
