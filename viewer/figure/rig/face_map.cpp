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
constexpr std::array<const char*, 8> kVrmNames{"aa", "ih",    "ou",        "ee",
                                               "oh", "blink", "blinkLeft", "blinkRight"};

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
  const std::array<float, kVrmNames.size()> of_vrm{
      vrm.aa, vrm.ih, vrm.ou, vrm.ee, vrm.oh, vrm.blink, vrm.blink_left, vrm.blink_right};
  std::copy(of_vrm.begin(), of_vrm.end(), weights.begin() + kExpressionCount);
  return weights;
}

}  // namespace

FaceMap::FaceMap(const AvatarModel& model) {
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
    found += binds_.size() > before ? 1 : 0;
  }
  if (found >= kEnough) return;
  binds_.clear();
  for (std::size_t v = 0; v < kVrmNames.size(); ++v)
    for (const AvatarExpression& expression : model.expressions)
      if (expression.name == kVrmNames[v])
        for (const AvatarExpression::Bind& bind : expression.binds)
          binds_.push_back(
              {static_cast<std::uint8_t>(kExpressionCount + v), bind.morph, bind.weight});
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
