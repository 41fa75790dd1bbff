#include "haptics/bhaptics/bhaptics_frame.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace dance {
namespace {

using Json = nlohmann::ordered_json;

// A vest has 4 columns and 5 rows of motors on each side, from the wearer's right above.
constexpr std::array<BhapticsPlace, kBoneCount> kPlaces{{
    {"VestFront", 17}, {"VestFront", 13}, {"VestFront", 9}, {"VestFront", 5},  {"VestBack", 1},
    {"Head", 2},       {"VestFront", 3},  {"ForearmL", 0},  {"ForearmL", 2},   {"HandL", 1},
    {"VestFront", 0},  {"ForearmR", 0},   {"ForearmR", 2},  {"HandR", 1},      {"VestFront", 19},
    {"FootL", 0},      {"FootL", 1},      {"FootL", 2},     {"VestFront", 16}, {"FootR", 0},
    {"FootR", 1},      {"FootR", 2},
}};

}  // namespace

BhapticsPlace bhaptics_place(Bone bone) { return kPlaces[index_of(bone)]; }

std::string bhaptics_frame(const Haptic& haptic) {
  const BhapticsPlace place = bhaptics_place(haptic.bone);
  const auto intensity = static_cast<int>(std::lround(100.0f * haptic.amplitude));
  Json frame;
  frame["Position"] = place.position;
  frame["DotPoints"] = Json::array({{{"Index", place.motor}, {"Intensity", intensity}}});
  frame["PathPoints"] = Json::array();
  frame["DurationMillis"] = haptic.duration.count_ms();
  Json submit;
  submit["Type"] = "frame";
  submit["Key"] = "dance-" + std::string(kBones[index_of(haptic.bone)].name);
  submit["Frame"] = frame;
  return Json{{"Submit", Json::array({submit})}}.dump();
}

std::string bhaptics_stop() { return R"({"Submit":[{"Type":"turnOffAll"}]})"; }

}  // namespace dance
