// FigureMesh: an AvatarModel as a graphics card takes it: packed vertices, triangles gathered into
// batches that one draw call can take, and the same figure with fewer and fewer triangles. Knows no
// OpenGL, so that a thread beside the drawing can build it.
//
// Units/frames: metres in the axes of the model's mesh.
// Ownership:    plain values; refers to no model.
// Threads:      none inside; figure_mesh() takes 5 to 80 ms.
// Failure:      none for a model that is_sound().
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "formats/avatar/avatar_model.h"

namespace dance {

// Materials that a batch can choose from: what 16 KiB of a uniform block hold, which every card
// has.
constexpr std::size_t kMaterialsOfGroup = 256;

struct FigureVertex {
  static constexpr std::uint32_t kOfTheHead = 1u << 16;  // not seen by the figure's own eyes

  std::array<float, 3> place_m;
  std::uint32_t normal;  // three signed parts of 10 bit
  std::array<float, 2> uv;
  std::array<std::uint16_t, 4> joints;  // by weight, the heaviest first
  std::array<std::uint8_t, 4> weights;
  std::uint32_t material;  // in its group; and kOfTheHead
  std::uint32_t morphs;    // the first of FigureMesh::morph_steps, and how many in the top 8 bits
};
static_assert(sizeof(FigureVertex) == 44);

// As the uniform block of the shaders has it.
struct FigureMaterial {
  Eigen::Vector4f base_colour;
  Eigen::Vector4f emission_and_gloss;
  Eigen::Vector4f shade_colour_and_shift;
  Eigen::Vector4f toony_and_cutoff;
};
static_assert(sizeof(FigureMaterial) == 64);

struct FigureBatch {
  int picture = -1;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  Shading shading = Shading::kLit;
  bool is_double_sided = false;
  FirstPerson audience = FirstPerson::kBoth;  // kAuto is here by vertices: kOfTheHead
  std::uint32_t material_group = 0;
  bool operator==(const FigureBatch&) const = default;
};

// How one morph moves one vertex, as half floats: place and number of the morph, normal and 0.
using MorphStep = std::array<std::uint16_t, 8>;

struct FigureLevel {
  struct Range {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
  };
  std::vector<Range> batches;  // of each FigureMesh::batches
  std::uint32_t triangle_count = 0;
  std::uint32_t vertex_count = 0;  // its triangles have vertices 0 .. vertex_count
};

struct FigureMesh {
  std::vector<FigureVertex> vertices;  // those of coarse levels first
  std::vector<std::uint32_t> indices;
  std::vector<FigureBatch> batches;
  std::vector<FigureLevel> levels;  // from fine to coarse
  std::vector<FigureMaterial> materials;
  std::vector<MorphStep> morph_steps;
};

std::shared_ptr<const FigureMesh> figure_mesh(const AvatarModel& model);

// The coarsest level that still has about so many triangles.
std::size_t level_for(const FigureMesh& mesh, double triangles);

}  // namespace dance
