#include "formats/gltf/glb_vrm.h"

#include "core/pose/bone.h"

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
  if (find_bone(name)) return true;
  for (const BoneInfo& finger : kFingerBones)
    if (finger.name == name) return true;
  return false;
}

const Value* member(const Value& value, const char* name) {
  return value.IsObject() && value.Has(name) ? &value.Get(name) : nullptr;
}

const Value* human_bones(const tinygltf::Model& model, const char* extension) {
  const auto found = model.extensions.find(extension);
  if (found == model.extensions.end()) return nullptr;
  const Value* humanoid = member(found->second, "humanoid");
  return humanoid ? member(*humanoid, "humanBones") : nullptr;
}

void add(const Value* node, const std::string& bone, const tinygltf::Model& model,
         std::map<int, std::string>& bones) {
  if (!node || !node->IsInt() || !is_bone(bone)) return;
  const int index = node->Get<int>();
  if (index >= 0 && static_cast<std::size_t>(index) < model.nodes.size()) bones[index] = bone;
}

}  // namespace

std::map<int, std::string> vrm_bones(const tinygltf::Model& model) {
  std::map<int, std::string> bones;
  for (const char* extension : {"VRMC_vrm", "VRMC_vrm_animation"}) {
    const Value* listed = human_bones(model, extension);
    if (!listed || !listed->IsObject()) continue;
    for (const std::string& bone : listed->Keys())
      add(member(listed->Get(bone), "node"), bone, model, bones);
  }
  const Value* listed = human_bones(model, "VRM");
  if (!listed || !listed->IsArray()) return bones;
  for (int i = 0; i < static_cast<int>(listed->ArrayLen()); ++i) {
    const Value& entry = listed->Get(i);
    const Value* bone = member(entry, "bone");
    if (bone && bone->IsString())
      add(member(entry, "node"), renamed_thumb(bone->Get<std::string>()), model, bones);
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
