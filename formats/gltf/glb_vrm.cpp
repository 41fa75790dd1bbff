#include "formats/gltf/glb_vrm.h"

#include "core/pose/bone.h"
#include "formats/gltf/glb_json.h"

namespace dance {
namespace {

using tinygltf::Value;

// VRM 0.x counts a thumb's bones as Unity does: its proximal bone is VRM 1.0's metacarpal.
std::string renamed_thumb(const std::string& bone) {
  if (bone == "leftThumbProximal") return "leftThumbMetacarpal";
  if (bone == "leftThumbIntermediate") return "leftThumbProximal";
  if (bone == "rightThumbProximal") return "rightThumbMetacarpal";
  if (bone == "rightThumbIntermediate") return "rightThumbProximal";
  return bone;
}

bool is_bone(const std::string& name) {
  if (find_bone(name) || name == "leftEye" || name == "rightEye") return true;
  for (const BoneInfo& finger : kFingerBones)
    if (finger.name == name) return true;
  return false;
}

const Value* human_bones(const tinygltf::Model& model, const char* extension) {
  return member(member(extension_of(model.extensions, extension), "humanoid"), "humanBones");
}

void add(const Value* node, const std::string& bone, const tinygltf::Model& model,
         std::map<int, std::string>& bones) {
  const auto index = index_in(node, model.nodes.size());
  if (index && is_bone(bone)) bones[*index] = bone;
}

}  // namespace

std::map<int, std::string> vrm_bones(const tinygltf::Model& model) {
  std::map<int, std::string> bones;
  for (const char* extension : {"VRMC_vrm", "VRMC_vrm_animation"}) {
    const Value* listed = human_bones(model, extension);
    if (!listed || !listed->IsObject()) continue;
    for (const std::string& bone : listed->Keys())
      add(member(member(listed, bone.c_str()), "node"), bone, model, bones);
  }
  const Value* listed = human_bones(model, "VRM");
  for (std::size_t i = 0; i < length_of(listed); ++i) {
    const Value* entry = item(listed, i);
    add(member(entry, "node"), renamed_thumb(text_of(member(entry, "bone"))), model, bones);
  }
  return bones;
}

void mark_vrm_animation(tinygltf::Model& model, int first_node, bool has_hands) {
  Value::Object bones;
  const auto add_bone = [&](std::string_view name, std::size_t joint) {
    Value::Object entry;
    entry["node"] = Value(first_node + static_cast<int>(joint));
    bones[std::string(name)] = Value(std::move(entry));
  };
  for (std::size_t b = 0; b < kBoneCount; ++b) add_bone(kBones[b].name, b);
  if (has_hands)
    for (std::size_t f = 0; f < kFingerBoneCount; ++f)
      add_bone(kFingerBones[f].name, kBoneCount + f);
  Value::Object humanoid;
  humanoid["humanBones"] = Value(std::move(bones));
  Value::Object extension;
  extension["specVersion"] = Value(std::string("1.0"));
  extension["humanoid"] = Value(std::move(humanoid));
  model.extensions["VRMC_vrm_animation"] = Value(std::move(extension));
  model.extensionsUsed.emplace_back("VRMC_vrm_animation");
}

}  // namespace dance
