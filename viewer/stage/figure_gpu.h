// FigureGpu: one model's mesh and pictures on the graphics card.
//
// Units/frames: as viewer/mesh/figure_mesh.h.
// Ownership:    owns its OpenGL objects; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      none: what does not fit is made smaller (FigureLimits).
#pragma once

#include <cstdint>
#include <vector>

#include "formats/avatar/avatar_model.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/mesh/figure_mesh.h"

namespace dance {

struct FigureLimits {
  int most_picture_px = 2048;  // larger pictures are halved until they fit
  bool is_coarse = false;      // the coarsest level only
};

// What a model takes on the card, in bytes.
std::size_t gpu_bytes(const AvatarModel& model, const FigureMesh& mesh, const FigureLimits& limits);

class FigureGpu {
 public:
  FigureGpu(const AvatarModel& model, const FigureMesh& mesh, const FigureLimits& limits);

  const FigureMesh& shape() const { return shape_; }  // batches and levels; no vertices
  bool has_morphs() const { return static_cast<bool>(morphs_); }
  std::size_t coarsest() const { return shape_.levels.size() - 1; }
  std::size_t bytes() const { return bytes_; }

  // Vertices, and morphs on texture unit `morph_unit`.
  void bind(int morph_unit) const;
  // The materials at uniform block binding 0 and the picture on unit `picture_unit`.
  void bind_batch(std::size_t batch, int picture_unit) const;
  void draw_batch(std::size_t batch, std::size_t level, GLsizei figures) const;

 private:
  static void describe_vertices();
  void upload_materials(const FigureMesh& mesh);
  void upload_morphs(const FigureMesh& mesh);
  void upload_pictures(const AvatarModel& model, int most_px);

  FigureMesh shape_;
  std::size_t bytes_ = 0;
  GlVertexArray array_;
  GlBuffer vertices_;
  GlBuffer indices_;
  GlBuffer materials_;
  GlBuffer morph_buffer_;
  GlTexture morphs_;
  std::vector<GlTexture> pictures_;
};

}  // namespace dance
