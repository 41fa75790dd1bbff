#include "formats/avatar/make/bent_figure.h"

#include <meshoptimizer.h>

#include <limits>

#include "formats/body/hand_layout.h"
#include "formats/body/implicit_surface.h"

namespace dance {

using Eigen::Affine3f;
using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

Quaternionf turn(float x_deg, float y_deg, float z_deg) {
  return AngleAxisf(z_deg * kRadians, Vector3f::UnitZ()) *
         AngleAxisf(y_deg * kRadians, Vector3f::UnitY()) *
         AngleAxisf(x_deg * kRadians, Vector3f::UnitX());
}

// Joints far enough bent that flat triangles across them would show.
Quaternionf bend_of(std::size_t joint) {
  if (joint >= kBoneCount) {
    const bool left = joint - kBoneCount < kFingerBoneCount / 2;
    const std::size_t finger = (joint - kBoneCount) / kBonesOfAFinger % 5;
    if (finger == 0) return turn(0.0f, left ? 25.0f : -25.0f, 0.0f);
    return turn(0.0f, 0.0f, left ? -55.0f : 55.0f);
  }
  switch (static_cast<Bone>(joint)) {
    case Bone::kLeftUpperArm:
      return turn(0.0f, 0.0f, -60.0f);
    case Bone::kRightUpperArm:
      return turn(0.0f, 0.0f, 60.0f);
    case Bone::kLeftLowerArm:
      return turn(0.0f, -80.0f, 0.0f);
    case Bone::kRightLowerArm:
      return turn(0.0f, 80.0f, 0.0f);
    case Bone::kLeftHand:
      return turn(0.0f, 0.0f, 35.0f);
    case Bone::kRightHand:
      return turn(0.0f, 0.0f, -35.0f);
    case Bone::kLeftUpperLeg:
    case Bone::kRightUpperLeg:
      return turn(-65.0f, 0.0f, 0.0f);
    case Bone::kLeftLowerLeg:
    case Bone::kRightLowerLeg:
      return turn(80.0f, 0.0f, 0.0f);
    case Bone::kLeftToes:
    case Bone::kRightToes:
      return turn(-30.0f, 0.0f, 0.0f);
    case Bone::kSpine:
    case Bone::kChest:
      return turn(12.0f, 0.0f, 8.0f);
    default:
      return Quaternionf::Identity();
  }
}

}  // namespace

BentFigure::BentFigure(const Skeleton& skeleton) : weighting_(skeleton) {
  const TposePlaces places(skeleton);
  const HandLayout layout = hand_layout(skeleton);
  std::vector<Vector3f> rest_m(places.bones_m.begin(), places.bones_m.end());
  std::vector<Affine3f> in_world;
  for (std::size_t joint = 0; joint < kBoneCount + kFingerBoneCount; ++joint) {
    int parent = -1;
    if (joint < kBoneCount) {
      parent = kBones[joint].parent;
    } else {
      const std::size_t finger = joint - kBoneCount;
      parent = kFingerBones[finger].parent < 0
                   ? static_cast<int>(index_of(hand_of_finger_bone(finger)))
                   : static_cast<int>(kBoneCount) + kFingerBones[finger].parent;
      rest_m.push_back(rest_m[static_cast<std::size_t>(parent)] + layout.offset_m[finger]);
    }
    Affine3f own = parent < 0 ? Affine3f::Identity() : in_world[static_cast<std::size_t>(parent)];
    own.translate(parent < 0 ? rest_m[joint]
                             : Vector3f(rest_m[joint] - rest_m[static_cast<std::size_t>(parent)]));
    own.rotate(bend_of(joint));
    in_world.push_back(own);
    bend_.push_back(own * Eigen::Translation3f(-rest_m[joint]));
  }
}

std::vector<Vector3f> BentFigure::bent(const Sheet& sheet) const {
  std::vector<Vector3f> places;
  for (const AvatarVertex& vertex : sheet.vertices) {
    Vector3f place = Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      place += static_cast<float>(vertex.weights[k]) / 255.0f *
               (bend_[vertex.joints[k]] * vertex.place_m);
    places.push_back(place);
  }
  return places;
}

Sheet BentFigure::build_sheet(const FigureLayer& layer, std::size_t most_triangles) const {
  const Surface surface = surface_of(layer);
  Sheet fine;
  for (std::size_t v = 0; v < surface.places_m.size(); ++v) {
    AvatarVertex vertex = vertex_at(surface.places_m[v]);
    vertex.normal = surface.normals[v];
    const SkinWeights skin = weighting_.weights_at(vertex.place_m, layer);
    for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = skin.joints[k];
    vertex.weights = skin.weights;
    fine.vertices.push_back(vertex);
  }
  const std::vector<Vector3f> places = bent(fine);
  std::vector<std::uint32_t> kept(surface.triangles.size());
  constexpr float kAnyError = 1.0f;
  kept.resize(meshopt_simplify(kept.data(), surface.triangles.data(), surface.triangles.size(),
                               places.front().data(), places.size(), sizeof(Vector3f),
                               3 * most_triangles, kAnyError, 0, nullptr));
  Sheet sheet;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> of(fine.vertices.size(), kNone);
  for (const std::uint32_t vertex : kept) {
    if (of[vertex] == kNone) {
      of[vertex] = static_cast<std::uint32_t>(sheet.vertices.size());
      sheet.vertices.push_back(fine.vertices[vertex]);
    }
    sheet.triangles.push_back(of[vertex]);
  }
  return sheet;
}

}  // namespace dance
