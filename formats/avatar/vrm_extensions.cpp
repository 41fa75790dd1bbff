#include "formats/avatar/vrm_extensions.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace dance {
namespace {

using Eigen::Vector3f;
using tinygltf::Value;
using Object = Value::Object;
using Array = Value::Array;

Value text(std::string_view words) { return Value(std::string(words)); }
// Through decimals of six places, so that files hold 0.35 and not 0.3499999940395355.
Value number(float value) {
  return Value(static_cast<double>(std::round(static_cast<double>(value) * 1e6)) / 1e6);
}
Value vector(const Vector3f& v) {
  return Value(Array{number(v.x()), number(v.y()), number(v.z())});
}

Value meta_value(const AvatarModel& model, const VrmMeta& meta) {
  Object out;
  out["name"] = text(meta.name.empty() ? model.name : meta.name);
  out["version"] = text(meta.version);
  Array authors;
  for (const std::string& author : meta.authors) authors.push_back(text(author));
  out["authors"] = Value(std::move(authors));
  if (!meta.copyright.empty()) out["copyrightInformation"] = text(meta.copyright);
  out["licenseUrl"] = text("https://vrm.dev/licenses/1.0/");
  if (!meta.licence_url.empty()) out["otherLicenseUrl"] = text(meta.licence_url);
  out["avatarPermission"] = text(meta.is_for_everyone ? "everyone" : "onlyAuthor");
  out["commercialUsage"] = text(meta.allows_commercial_use ? "corporation" : "personalNonProfit");
  out["creditNotation"] = text(meta.needs_credit ? "required" : "unnecessary");
  out["allowRedistribution"] = Value(meta.allows_redistribution);
  out["modification"] =
      text(meta.allows_redistribution ? "allowModificationRedistribution" : "prohibited");
  return Value(std::move(out));
}

Value humanoid_value(const AvatarModel& model) {
  Object bones;
  const auto add = [&](std::string_view name, int node) {
    if (node >= 0) bones[std::string(name)] = Value(Object{{"node", Value(node)}});
  };
  for (std::size_t b = 0; b < kBoneCount; ++b) add(kBones[b].name, model.bones[b]);
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) add(kFingerBones[f].name, model.fingers[f]);
  add("leftEye", model.eyes[0]);
  add("rightEye", model.eyes[1]);
  return Value(Object{{"humanBones", Value(std::move(bones))}});
}

std::string_view word_of(FirstPerson kind) {
  switch (kind) {
    case FirstPerson::kBoth:
      return "both";
    case FirstPerson::kThirdPersonOnly:
      return "thirdPersonOnly";
    case FirstPerson::kFirstPersonOnly:
      return "firstPersonOnly";
    case FirstPerson::kAuto:
      break;
  }
  return "auto";
}

Value first_person_value(const std::vector<VrmMesh>& meshes) {
  Array annotations;
  for (const VrmMesh& mesh : meshes)
    annotations.push_back(
        Value(Object{{"node", Value(mesh.node)}, {"type", text(word_of(mesh.first_person))}}));
  return Value(Object{{"meshAnnotations", Value(std::move(annotations))}});
}

// How far eyes turn: a gaze 90° aside turns them by `output_deg`.
Value range(float output_deg) {
  return Value(Object{{"inputMaxValue", number(90.0f)}, {"outputScale", number(output_deg)}});
}

Value look_at_value(const AvatarModel& model) {
  Object out;
  const bool has_eyes = model.eyes[0] >= 0 && model.eyes[1] >= 0;
  Vector3f between(0.0f, 0.06f, 0.0f);
  if (has_eyes) {
    between.setZero();
    for (const int eye : model.eyes)
      between += 0.5f * model.nodes[static_cast<std::size_t>(eye)].translation_m;
  }
  out["offsetFromHeadBone"] = vector(between);
  out["type"] = text(has_eyes ? "bone" : "expression");
  out["rangeMapHorizontalInner"] = range(12.0f);
  out["rangeMapHorizontalOuter"] = range(16.0f);
  out["rangeMapVerticalDown"] = range(10.0f);
  out["rangeMapVerticalUp"] = range(10.0f);
  return Value(std::move(out));
}

constexpr std::array<std::string_view, 18> kPresets{
    "happy",      "angry",  "sad",      "relaxed",  "surprised", "aa",
    "ih",         "ou",     "ee",       "oh",       "blink",     "blinkLeft",
    "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight", "neutral"};

Value expressions_value(const AvatarModel& model, const std::vector<VrmMesh>& meshes) {
  Object preset;
  Object custom;
  for (const AvatarExpression& expression : model.expressions) {
    Array binds;
    for (const AvatarExpression::Bind& bind : expression.binds)
      for (const VrmMesh& mesh : meshes) {
        const auto at = std::ranges::find(mesh.morphs, bind.morph);
        if (at == mesh.morphs.end()) continue;
        binds.push_back(Value(Object{{"node", Value(mesh.node)},
                                     {"index", Value(static_cast<int>(at - mesh.morphs.begin()))},
                                     {"weight", number(std::clamp(bind.weight, 0.0f, 1.0f))}}));
      }
    Object out;
    out["isBinary"] = Value(false);
    if (!binds.empty()) out["morphTargetBinds"] = Value(std::move(binds));
    // A smile that closes the eyes leaves a blink nothing to close.
    for (const char* override : {"overrideBlink", "overrideLookAt", "overrideMouth"})
      out[override] = text("none");
    const bool is_preset = std::ranges::find(kPresets, expression.name) != kPresets.end();
    (is_preset ? preset : custom)[expression.name] = Value(std::move(out));
  }
  Object out;
  if (!preset.empty()) out["preset"] = Value(std::move(preset));
  if (!custom.empty()) out["custom"] = Value(std::move(custom));
  return Value(std::move(out));
}

Value collider_value(const AvatarCollider& collider) {
  Object shape;
  shape["offset"] = vector(collider.centre_m);
  shape["radius"] = number(collider.radius_m);
  const bool is_ball = (collider.tail_m - collider.centre_m).norm() < 1e-6f;
  if (!is_ball) shape["tail"] = vector(collider.tail_m);
  Object kind;
  kind[is_ball ? "sphere" : "capsule"] = Value(std::move(shape));
  return Value(Object{{"node", Value(collider.node)}, {"shape", Value(std::move(kind))}});
}

Value spring_joint_value(const AvatarSpring::Joint& joint) {
  return Value(Object{{"node", Value(joint.node)},
                      {"hitRadius", number(joint.radius_m)},
                      {"stiffness", number(joint.stiffness)},
                      {"gravityPower", number(joint.gravity)},
                      {"gravityDir", vector(joint.gravity_direction)},
                      {"dragForce", number(std::clamp(joint.drag, 0.0f, 1.0f))}});
}

}  // namespace

Value vrm_extension(const AvatarModel& model, const VrmMeta& meta,
                    const std::vector<VrmMesh>& meshes) {
  Object out;
  out["specVersion"] = text("1.0");
  out["meta"] = meta_value(model, meta);
  out["humanoid"] = humanoid_value(model);
  out["firstPerson"] = first_person_value(meshes);
  out["lookAt"] = look_at_value(model);
  if (!model.expressions.empty()) out["expressions"] = expressions_value(model, meshes);
  return Value(std::move(out));
}

Value spring_extension(const AvatarModel& model, const std::vector<int>& ends) {
  Array colliders;
  for (const AvatarCollider& collider : model.colliders)
    colliders.push_back(collider_value(collider));
  std::map<std::vector<std::uint32_t>, int> group_of;
  Array groups;
  Array springs;
  for (std::size_t s = 0; s < model.springs.size(); ++s) {
    const AvatarSpring& spring = model.springs[s];
    if (spring.joints.empty()) continue;
    Array joints;
    for (const AvatarSpring::Joint& joint : spring.joints)
      joints.push_back(spring_joint_value(joint));
    joints.push_back(Value(Object{{"node", Value(ends[s])}}));
    Object out;
    const auto first = static_cast<std::size_t>(spring.joints.front().node);
    out["name"] = text(model.nodes[first].name);
    out["joints"] = Value(std::move(joints));
    if (!spring.colliders.empty()) {
      const auto [at, is_new] =
          group_of.try_emplace(spring.colliders, static_cast<int>(groups.size()));
      if (is_new) {
        Array members;
        for (const std::uint32_t c : spring.colliders)
          members.push_back(Value(static_cast<int>(c)));
        groups.push_back(Value(Object{{"colliders", Value(std::move(members))}}));
      }
      out["colliderGroups"] = Value(Array{Value(at->second)});
    }
    if (spring.centre >= 0) out["center"] = Value(spring.centre);
    springs.push_back(Value(std::move(out)));
  }
  Object out;
  out["specVersion"] = text("1.0");
  if (!colliders.empty()) out["colliders"] = Value(std::move(colliders));
  if (!groups.empty()) out["colliderGroups"] = Value(std::move(groups));
  if (!springs.empty()) out["springs"] = Value(std::move(springs));
  return Value(std::move(out));
}

Value mtoon_extension(const AvatarMaterial& material) {
  Object out;
  out["specVersion"] = text("1.0");
  out["shadeColorFactor"] = vector(material.shade_colour);
  out["shadingShiftFactor"] = number(material.shade_shift);
  out["shadingToonyFactor"] = number(std::clamp(material.shade_toony, 0.0f, 1.0f));
  out["giEqualizationFactor"] = number(0.9f);
  if (material.picture >= 0)
    out["shadeMultiplyTexture"] = Value(Object{{"index", Value(material.picture)}});
  return Value(std::move(out));
}

}  // namespace dance
