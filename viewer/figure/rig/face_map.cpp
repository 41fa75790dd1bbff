#include "viewer/figure/rig/face_map.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "core/pose/face_shapes.h"

namespace dance {
namespace {

// With so many of ARKit's names a figure was made for them.
constexpr int kEnough = 10;

// The abilities of both sets of names: a figure uses VRM's names for each ability that its ARKit
// names lack.
enum class Ability : std::uint8_t { kMouth, kLids, kSmile, kLook, kOther };
constexpr std::size_t kAbilityCount = 5;

struct VrmName {
  const char* name;
  Ability ability;
};
constexpr std::array<VrmName, 13> kVrmNames{{{"aa", Ability::kMouth},
                                             {"ih", Ability::kMouth},
                                             {"ou", Ability::kMouth},
                                             {"ee", Ability::kMouth},
                                             {"oh", Ability::kMouth},
                                             {"blink", Ability::kLids},
                                             {"blinkLeft", Ability::kLids},
                                             {"blinkRight", Ability::kLids},
                                             {"happy", Ability::kSmile},
                                             {"lookUp", Ability::kLook},
                                             {"lookDown", Ability::kLook},
                                             {"lookLeft", Ability::kLook},
                                             {"lookRight", Ability::kLook}}};

Ability ability_of(std::string_view arkit_name) {
  if (arkit_name.starts_with("eyeLook")) return Ability::kLook;
  if (arkit_name.starts_with("eyeBlink")) return Ability::kLids;
  if (arkit_name.starts_with("mouthSmile")) return Ability::kSmile;
  return arkit_name == "jawOpen" ? Ability::kMouth : Ability::kOther;
}

// "eyeBlink_L" and "EyeBlinkLeft" are one name.
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool has_mark = name.size() > 2 && name[name.size() - 2] == '_';
  if (has_mark && out.ends_with('l')) out.replace(out.size() - 1, 1, "left");
  if (has_mark && out.ends_with('r')) out.replace(out.size() - 1, 1, "right");
  return out;
}

std::array<float, kExpressionCount + kVrmNames.size()> weights_of(const Face& face) {
  std::array<float, kExpressionCount + kVrmNames.size()> weights{};
  std::copy(face.weight.begin(), face.weight.end(), weights.begin());
  const VrmFace vrm = vrm_face(face);
  using E = Expression;
  const auto both = [&](E left, E right) { return 0.5f * (face[left] + face[right]); };
  const std::array<float, kVrmNames.size()> of_vrm{vrm.aa,
                                                   vrm.ih,
                                                   vrm.ou,
                                                   vrm.ee,
                                                   vrm.oh,
                                                   vrm.blink,
                                                   vrm.blink_left,
                                                   vrm.blink_right,
                                                   both(E::kMouthSmileLeft, E::kMouthSmileRight),
                                                   both(E::kEyeLookUpLeft, E::kEyeLookUpRight),
                                                   both(E::kEyeLookDownLeft, E::kEyeLookDownRight),
                                                   both(E::kEyeLookOutLeft, E::kEyeLookInRight),
                                                   both(E::kEyeLookInLeft, E::kEyeLookOutRight)};
  std::copy(of_vrm.begin(), of_vrm.end(), weights.begin() + kExpressionCount);
  return weights;
}

}  // namespace

FaceMap::FaceMap(const AvatarModel& model) {
  std::array<bool, kAbilityCount> has_ability{};
  if (add_arkit(model, has_ability) < kEnough) {
    binds_.clear();
    has_ability = {};
  }
  for (std::size_t v = 0; v < kVrmNames.size(); ++v) {
    const VrmName& wanted = kVrmNames[v];
    if (has_ability[static_cast<std::size_t>(wanted.ability)]) continue;
    for (const AvatarExpression& expression : model.expressions)
      if (expression.name == wanted.name) {
        const auto source = static_cast<std::uint8_t>(kExpressionCount + v);
        for (const AvatarExpression::Bind& bind : expression.binds)
          binds_.push_back({source, bind.morph, bind.weight});
        has_look_ = has_look_ || (wanted.ability == Ability::kLook && !expression.binds.empty());
      }
  }
  has_look_ = has_look_ || has_ability[static_cast<std::size_t>(Ability::kLook)];
}

int FaceMap::add_arkit(const AvatarModel& model, std::span<bool> has_ability) {
  std::vector<std::string> morphs, expressions;
  for (const auto& morph : model.morphs) morphs.push_back(plain(morph.name));
  for (const auto& expression : model.expressions) expressions.push_back(plain(expression.name));
  int found = 0;
  for (std::size_t e = 0; e < kExpressionCount; ++e) {
    const std::string wanted = plain(kExpressionNames[e]);
    const std::size_t before = binds_.size();
    for (std::size_t m = 0; m < morphs.size(); ++m)
      if (morphs[m] == wanted)
        binds_.push_back({static_cast<std::uint8_t>(e), static_cast<std::uint32_t>(m), 1.0f});
    for (std::size_t x = 0; x < expressions.size(); ++x)
      if (binds_.size() == before && expressions[x] == wanted)
        for (const AvatarExpression::Bind& bind : model.expressions[x].binds)
          binds_.push_back({static_cast<std::uint8_t>(e), bind.morph, bind.weight});
    if (binds_.size() == before) continue;
    ++found;
    has_ability[static_cast<std::size_t>(ability_of(kExpressionNames[e]))] = true;
  }
  return found;
}

void FaceMap::add(const Face& face, std::span<float> morph_weights) const {
  const auto weights = weights_of(face);
  for (const Bind& bind : binds_) {
    if (bind.morph >= morph_weights.size()) continue;
    float& weight = morph_weights[bind.morph];
    weight = std::clamp(weight + bind.weight * weights[bind.source], 0.0f, 1.0f);
  }
}

}  // namespace dance
