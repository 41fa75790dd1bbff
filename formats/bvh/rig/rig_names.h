// Parses a joint's name: which part of which side of a body, as many tools write it. Some words are
// ambiguous (in one tool "shoulder" is the collar bone, in another the upper arm; "hip", "leg" and
// "arm" alike), and resolved by the other joints of the figure.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   an unknown name is RigPart::kNone.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dance {

enum class RigSide : std::uint8_t { kMiddle, kLeft, kRight };

enum class RigPart : std::uint8_t {
  kNone,
  kHips,
  kSpine,
  kNeck,
  kHead,
  kCollar,
  kShoulder,  // the collar bone or the upper arm
  kArm,       // the upper arm or, beside an upper arm, the lower
  kUpperArm,
  kLowerArm,
  kWrist,
  kHand,
  kThigh,
  kHip,  // of one side: the thigh's joint
  kLeg,  // the lower leg or, beside a lower leg, the upper
  kShin,
  kAnkle,
  kFoot,
  kToes,
  kThumb,
  kIndex,
  kMiddle,
  kRing,
  kLittle,
  kHelper,  // twist, roll and end joints: never a bone of their own
};

struct RigName {
  RigSide side = RigSide::kMiddle;
  RigPart part = RigPart::kNone;
};

// The part that all names of a figure begin with ("mixamorig:", "Bip01 "), to be left out of each.
std::string_view common_prefix(const std::vector<std::string_view>& names);

RigName read_rig_name(std::string_view name);

// The side of a joint that turns an eye, by its name; kMiddle for all else, as eyelids and brows.
RigSide eye_side(std::string_view name);

}  // namespace dance
