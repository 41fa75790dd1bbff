// The JSON schemas of our MCAP files: two of Foxglove's, as its 3D panel wants them, and our own
// for what transforms cannot hold.
//
// Units/frames: as each schema's descriptions say.
// Ownership:    constants.
// Threads:      constants only.
// Failure:      none.
// Source:       Foxglove schemas: FrameTransforms, SceneUpdate (facts; the texts are ours).
#pragma once

#include <array>
#include <string_view>

#include "core/pose/bone.h"

namespace dance {

struct DanceSchema {
  std::string_view name;
  std::string_view json;
};

extern const DanceSchema kFrameTransformsSchema;
extern const DanceSchema kSceneUpdateSchema;
extern const DanceSchema kPoseSchema;   // of one guest: all of a pose but its rotations
extern const DanceSchema kHandsSchema;  // of one guest
extern const DanceSchema kBeatSchema;

// Topics: one of each for a guest, and those of the house.
constexpr std::string_view kGuestTopic = "/guest/";  // then its id, then one of the four
constexpr std::string_view kTransformsTopic = "/transforms";
constexpr std::string_view kBodyTopic = "/body";
constexpr std::string_view kPoseTopic = "/pose";
constexpr std::string_view kHandsTopic = "/hands";
constexpr std::string_view kStageTopic = "/stage/transforms";
constexpr std::string_view kFloorTopic = "/stage/floor";
constexpr std::string_view kBeatTopic = "/beat";

// Frames: "world" is +Z up, as Foxglove has it; "stage" in it is W.
constexpr std::string_view kWorldFrame = "world";
constexpr std::string_view kStageFrame = "stage";
// The ends of the body, each in its bone: "<guest>/headTip".
constexpr std::array<std::string_view, kTipCount> kTipFrames{
    "headTip", "leftHandTip", "rightHandTip", "leftToesTip", "rightToesTip"};

}  // namespace dance
