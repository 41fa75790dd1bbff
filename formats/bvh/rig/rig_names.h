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
  kNumberedFinger,  // until resolve_numbered_fingers() finds which finger
  kHelper,          // twist, roll and end joints: never a bone of their own
};

struct RigName {
  RigSide side = RigSide::kMiddle;
  RigPart part = RigPart::kNone;
  // Words and marks around the part's own: of two joints with one part the plainer is the bone.
  int decoration = 0;
  bool is_palm = false;            // the name contains metacarpal
  std::string finger_digits = {};  // of kNumberedFinger
};

// The part that all names of a figure begin with ("mixamorig:", "Bip01 "), to be left out of each;
// below a root of other software the part that most of them begin with.
std::string_view common_prefix(const std::vector<std::string_view>& names);

RigName read_rig_name(std::string_view name);

// Fingers are numbered from the thumb, from 0 or from 1; the numbers that occur decide which. A
// thumb's metacarpal is a bone, that of another finger is a joint of the palm.
void resolve_numbered_fingers(std::vector<RigName>& names);

// The side of a joint that turns an eye, by its name; kMiddle for all else, as eyelids and brows.
RigSide eye_side(std::string_view name);

}  // namespace dance
