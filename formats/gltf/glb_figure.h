// A figure of a glTF file as if it had been captured as BVH, so that one retargeting serves both:
// joints by name with world-aligned rest frames, and their motion through an animation.
//
// Units/frames: the file's world, metres, +Y up; see formats/bvh/bvh.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      bvh_of() of a figure with too many joints or frames says so.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/bvh/bvh.h"
#include "formats/gltf/glb_animation.h"

namespace dance {

struct GlbFigure {
  std::string name;                  // of its skin, or of the root; may be empty
  std::vector<int> above;            // the nodes above the root, outermost first
  std::vector<int> joints;           // the root and all below it, each after its parent
  std::map<int, std::string> bones;  // VRM's names of nodes, where the file tells them
};

// Where skins are, their skeletons; else the trees of the scene.
std::vector<GlbFigure> find_figures(const tinygltf::Model& model, const GlbScene& scene);
// The trees of the scene; skins are ignored, because the skin of a head alone names no legs.
std::vector<GlbFigure> figures_of_trees(const tinygltf::Model& model, const GlbScene& scene);

// The tracks that move the figure; empty where the animation leaves it alone.
std::vector<const GlbTrack*> tracks_of(const GlbFigure& figure, const GlbAnimation& animation,
                                       const GlbScene& scene);

// The joints alone, at rest.
Bvh rest_of(const GlbFigure& figure, const GlbScene& scene);
// The figure of a node and all below it.
GlbFigure figure_below(const GlbScene& scene, int root);

Result<Bvh> bvh_of(const GlbFigure& figure, const GlbScene& scene, const GlbAnimation& animation,
                   const GlbLimits& limits);

}  // namespace dance
