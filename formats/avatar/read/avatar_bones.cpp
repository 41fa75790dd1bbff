#include "formats/avatar/read/avatar_bones.h"

#include <algorithm>
#include <map>
#include <optional>

#include "formats/avatar/read/avatar_nodes.h"
#include "formats/body/hand_layout.h"
#include "formats/bvh/rig/rig.h"
#include "formats/bvh/rig/rig_names.h"
#include "formats/gltf/glb_figure.h"
#include "formats/gltf/glb_vrm.h"

namespace dance {
namespace {

struct Found {
  std::array<int, kBoneCount> bones;  // nodes of the model, -1 where there is none
  std::array<int, kFingerBoneCount> fingers;
  std::array<int, 2> eyes{-1, -1};

  Found() {
    bones.fill(-1);
    fingers.fill(-1);
  }
  int& operator[](Bone bone) { return bones[index_of(bone)]; }
  int at(Bone bone) const { return bones[index_of(bone)]; }
};

std::vector<Bone> missing_of(const Found& found) {
  std::vector<Bone> missing;
  for (const Bone bone : kNeededBones)
    if (found.at(bone) < 0) missing.push_back(bone);
  return missing;
}

std::string listed(const std::vector<Bone>& bones) {
  std::string text;
  for (const Bone bone : bones)
    text += (text.empty() ? "" : ", ") + std::string(kBones[index_of(bone)].name);
  return text;
}

Found told_by_vrm(const AvatarSource& source) {
  Found found;
  for (const auto& [node, name] : vrm_bones(source.file)) {
    const int at = source.model_node(node);
    if (const auto bone = find_bone(name)) found[*bone] = at;
    if (name == "leftEye") found.eyes[0] = at;
    if (name == "rightEye") found.eyes[1] = at;
    for (std::size_t f = 0; f < kFingerBoneCount; ++f)
      if (kFingerBones[f].name == name) found.fingers[f] = at;
  }
  return found;
}

// Where the hips of a rig hang beside the spine, as Character Creator's and Daz's pelvis does, the
// joint above both moves the whole body.
void put_hips_above_spine(const AvatarModel& model, Found& found) {
  const int head = found.at(Bone::kHead);
  int hips = found.at(Bone::kHips);
  if (head < 0 || hips < 0 || is_above(model, hips, head)) return;
  while (hips >= 0 && !is_above(model, hips, head))
    hips = model.nodes[static_cast<std::size_t>(hips)].parent;
  if (hips < 0) return;
  // Not a root on the floor.
  const auto places = rest_transforms(model);
  const auto height = [&](int node) {
    return places[static_cast<std::size_t>(node)].translation().y();
  };
  if (height(hips) > 0.3 * height(found.at(Bone::kHips))) found[Bone::kHips] = hips;
}

struct FoundByNames {
  Found found;
  std::string assumption;
};

std::optional<FoundByNames> found_by_names(const AvatarSource& source, const GlbFigure& figure,
                                           std::string& why) {
  if (figure.joints.size() > source.limits.joints) return std::nullopt;
  const auto rig = find_rig(rest_of(figure, source.scene));
  if (!rig) {
    if (why.empty()) why = rig.error().what;
    return std::nullopt;
  }
  const auto node_of = [&](int joint) {
    return joint == kNoJoint ? -1
                             : source.model_node(figure.joints[static_cast<std::size_t>(joint)]);
  };
  Found found;
  for (std::size_t b = 0; b < kBoneCount; ++b) found.bones[b] = node_of(rig->joint_of[b]);
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) found.fingers[f] = node_of(rig->finger_of[f]);
  put_hips_above_spine(source.model, found);
  for (const int file_node : figure.joints) {
    const int node = source.model_node(file_node);
    const RigSide side = eye_side(source.scene.at(file_node).name);
    if (side == RigSide::kMiddle || found.at(Bone::kHead) < 0 ||
        !is_above(source.model, found.at(Bone::kHead), node))
      continue;
    int& eye = found.eyes[side == RigSide::kLeft ? 0 : 1];
    if (eye < 0) eye = node;
  }
  return FoundByNames{found, rig->assumption};
}

// The figure of a skin may leave out joints above it that the rig needs: whole trees come last.
std::vector<GlbFigure> candidates(const AvatarSource& source) {
  std::vector<GlbFigure> figures = find_figures(source.file, source.scene);
  std::stable_sort(figures.begin(), figures.end(),
                   [](const auto& a, const auto& b) { return a.joints.size() > b.joints.size(); });
  constexpr std::size_t kMostTried = 8;
  if (figures.size() > kMostTried) figures.resize(kMostTried);
  std::vector<int> roots;
  for (const GlbFigure& figure : figures)
    if (!figure.above.empty() &&
        std::find(roots.begin(), roots.end(), figure.above.front()) == roots.end())
      roots.push_back(figure.above.front());
  for (const int root : roots) figures.push_back(figure_below(source.scene, root));
  return figures;
}

Result<Found> find_bones(AvatarSource& source) {
  Found told = told_by_vrm(source);
  std::vector<Bone> missing = missing_of(told);
  if (missing.empty()) return told;
  const bool is_told = missing.size() < kNeededBones.size();
  std::string why;
  for (const GlbFigure& figure : candidates(source)) {
    const auto named = found_by_names(source, figure, why);
    if (!named) continue;
    const std::vector<Bone> lacking = missing_of(named->found);
    if (lacking.empty()) {
      if (!named->assumption.empty()) source.note(named->assumption);
      return named->found;
    }
    if (!is_told) missing = lacking;
    why.clear();
  }
  if (!why.empty() && !is_told) return fail(why);
  return fail("no human figure: no node for " + listed(missing) +
              "; name the bones as VRM, Mixamo, Unreal or Blender do");
}

// Each bone hangs from the next that is there of those before it, or is left out.
Result<void> check_tree(AvatarSource& source, Found& found) {
  std::vector<Bone> wrong;
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    if (found.bones[b] < 0) continue;
    int above = kBones[b].parent;
    while (above > 0 && found.bones[static_cast<std::size_t>(above)] < 0)
      above = kBones[static_cast<std::size_t>(above)].parent;
    const int parent = found.bones[static_cast<std::size_t>(above)];
    if (parent != found.bones[b] && is_above(source.model, parent, found.bones[b])) continue;
    const auto bone = static_cast<Bone>(b);
    if (std::find(kNeededBones.begin(), kNeededBones.end(), bone) != kNeededBones.end())
      wrong.push_back(bone);
    found.bones[b] = -1;
    source.note(std::string(kBones[b].name) + " does not hang from the bone before it; left out");
  }
  if (!wrong.empty())
    return fail("no human figure: " + listed(wrong) +
                " does not hang from the bone before it; export the skeleton as one tree");
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    if (found.fingers[f] < 0) continue;
    const int before = kFingerBones[f].parent;
    int parent = before >= 0 ? found.fingers[static_cast<std::size_t>(before)] : -1;
    if (parent < 0) parent = found.at(hand_of_finger_bone(f));
    if (parent == found.fingers[f] || !is_above(source.model, parent, found.fingers[f]))
      found.fingers[f] = -1;
  }
  for (int& eye : found.eyes)
    if (eye >= 0 && !is_above(source.model, found.at(Bone::kHead), eye)) eye = -1;
  return {};
}

}  // namespace

Result<void> read_bones(AvatarSource& source) {
  DANCE_TRY(Found found, find_bones(source));
  if (auto checked = check_tree(source, found); !checked) return checked;
  source.model.bones = found.bones;
  source.model.fingers = found.fingers;
  source.model.eyes = found.eyes;
  return {};
}

}  // namespace dance
