// The figure of a dancer as a skinned mesh in T-pose: for files and engines that draw triangles.
//
// Units/frames: metres, W; the middle of the floor below the hips is the origin. Joint b is bone b,
//               kBoneCount + f is finger bone f.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

#include "formats/body/figure_part.h"
#include "formats/body/guest_look.h"
#include "formats/body/skin_weights.h"

namespace dance {

struct BodyMeshPart {
  Material material = Material::kSkin;
  std::vector<Eigen::Vector3f> places_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<SkinWeights> skin;  // one for each vertex
  std::vector<std::uint32_t> triangles;
};

// One part for each material. With fingers it follows those; else the hands are mittens.
std::vector<BodyMeshPart> body_mesh(const Skeleton& skeleton, const GuestLook& look,
                                    bool has_fingers);

// The body without head and hair, for figures that have their own.
std::vector<BodyMeshPart> body_mesh_below_head(const Skeleton& skeleton, const GuestLook& look,
                                               bool has_fingers);

struct MaterialLook {
  std::string_view name;
  Eigen::Vector3f colour;  // linear RGB
  float roughness;
};
MaterialLook look_of(Material material, const GuestLook& look);

}  // namespace dance
