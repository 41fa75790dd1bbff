// VmcWriter: a dancer's poses as messages of the VMC protocol 3.1, Performer to Marionette: bundles
// that fit an Ethernet frame, about 4.8 kB in four packets for a pose.
//
// Where the dancer is: Root is the stage's origin, without a turn, and the hips carry place and
// turn. VirtualMotionCapture, the protocol's own performer, does the same. Receivers that put Root
// and hips together (EVMC4U, the protocol's own receiver) show the right place, and so do those
// that look at the hips alone; were the place in Root, the latter would dance on the spot.
//
// Bones carry the dancer's real proportions, as some receivers take them over; most leave them.
//
// Units/frames: poses and skeletons as core/pose has them; written in Unity's axes.
// Ownership:    refers to the sink, which must outlive it; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       VMC protocol specification 3.1, Marionette.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/pose/face.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "formats/osc/osc_bundle_writer.h"
#include "formats/osc/vmc_bones.h"

namespace dance {

// Which names blend shapes have. Bones have those of Unity in both, as the protocol has no others.
enum class VmcDialect : std::uint8_t { kVrm0, kVrm1 };

class VmcWriter {
 public:
  VmcWriter(OscPacketSink& sink, VmcDialect dialect);

  void set_skeleton(const Skeleton& skeleton);
  // A whole frame: state, time, root, bones, blend shapes. hands: nullptr = at rest; face: nullptr
  // = what another program sends of it stays as it is.
  void write_pose(const Pose& pose, const Hands* hands, float time_s, const Face* face = nullptr);
  // That the sender is there while no pose is: before the dancer comes, and while they are silent.
  void write_silence(bool has_dancer, float time_s);
  // Which dancer this is: as the title of a model that the receiver does not have to load.
  void write_model(const char* title);

 private:
  void add_state(bool has_dancer, bool is_tracked, float time_s);
  // The 52 of ARKit by their names ("perfect sync"), and what VRM's own make of them.
  void add_expressions(const Face& face);
  void add_transform(const char* address, const char* name, const Eigen::Vector3f& p_m,
                     const Eigen::Quaternionf& R);

  OscBundleWriter bundles_;
  VmcDialect dialect_;
  std::array<Eigen::Vector3f, kVmcBoneCount> rest_m_;  // order of kVmcBones
};

}  // namespace dance
