// Figures for tests of drawing: flat sheets whose pixels are known beforehand.
//
// Units/frames: metres in W; a sheet stands upright and faces +Z.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <memory>
#include <utility>

#include "viewer/figure/figure_poser.h"

namespace dance {

// One joint, and one sheet of 1 m by 1 m round the origin for each material. u grows with X, and
// v downwards. Sheet i is i cm behind the first.
inline AvatarModel sheet_model(std::vector<AvatarMaterial> materials) {
  AvatarModel model;
  model.nodes.resize(1);
  model.joints.resize(1);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(model.vertices.size());
    for (const auto& [x, y] :
         {std::pair{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}}) {
      AvatarVertex vertex;
      vertex.place_m = {x, y, -0.01f * static_cast<float>(i)};
      vertex.normal = Eigen::Vector3f::UnitZ();
      vertex.uv = {x + 0.5f, 0.5f - y};
      model.vertices.push_back(vertex);
    }
    AvatarPart part;
    part.first_index = static_cast<std::uint32_t>(model.triangles.size());
    part.index_count = 6;
    part.material = static_cast<std::uint32_t>(i);
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u})
      model.triangles.push_back(first + corner);
    model.parts.push_back(part);
  }
  model.materials = std::move(materials);
  model.bones.fill(0);
  return model;
}

inline AvatarMaterial plain(float r, float g, float b, float alpha = 1.0f) {
  AvatarMaterial material;
  material.base_colour = {r, g, b, alpha};
  material.shading = Shading::kUnlit;
  if (alpha < 1.0f) material.alpha_mode = AlphaMode::kBlend;
  return material;
}

inline PosedFigure figure_at(const char* name, std::shared_ptr<const AvatarModel> model,
                             const Eigen::Vector3f& place_m) {
  PosedFigure figure;
  figure.id = *GuestId::parse(name);
  JointMatrix W_from_joint = JointMatrix::Zero();
  W_from_joint.leftCols<3>().setIdentity();
  W_from_joint.col(3) = place_m;
  figure.W_from_joint.assign(model->joints.size(), W_from_joint);
  figure.morph_weights.assign(model->morphs.size(), 0.0f);
  figure.frames.p_WB_m.fill(place_m);
  figure.model = std::move(model);
  return figure;
}

}  // namespace dance
