// VmcMessage: what a message of the VMC protocol says of a dancer, checked: this is where VMC's
// numbers come in. Addresses that say nothing of one (cameras, keys, trackers, ...) are kOther;
// arguments beyond those that the protocol had first are ignored, as it asks of receivers.
//
// Units/frames: metres and quaternions in our axes, mirrored from Unity's; time_s is the sender's.
// Ownership:    name is a view of the packet.
// Threads:      none inside.
// Failure:      kMalformed: too few arguments, of another type, not finite, a rotation that is
//               none, a place outside the stage.
// Source:       VMC protocol specification 3.1, Marionette.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string_view>

#include "formats/osc/osc_message.h"

namespace dance {

struct VmcMessage {
  enum class Kind : std::uint8_t {
    kAvailable,   // /VMC/Ext/OK
    kTime,        // /VMC/Ext/T
    kRoot,        // /VMC/Ext/Root/Pos
    kBone,        // /VMC/Ext/Bone/Pos
    kBlend,       // /VMC/Ext/Blend/Val
    kBlendApply,  // /VMC/Ext/Blend/Apply
    kOther,
    kMalformed,
  };
  Kind kind = Kind::kOther;
  std::string_view name;                                  // of a bone or a blend shape
  Eigen::Vector3f p_m = Eigen::Vector3f::Zero();          // of root or bone, in its parent
  Eigen::Quaternionf R = Eigen::Quaternionf::Identity();  // of root or bone, in its parent
  float time_s = 0.0f;
  float value = 0.0f;  // of a blend shape
  bool is_loaded = false;
  bool has_doubles = false;  // kMalformed: numbers are doubles, where the protocol has floats
};

VmcMessage parse_vmc(const OscMessage& message);

}  // namespace dance
