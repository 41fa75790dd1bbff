// FigurePrograms: the shader programs of figures, one for each kind of material, linked when a
// model first needs them.
//
// Units/frames: none.
// Ownership:    owns its programs; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      link() tells what the driver refuses.
#pragma once

#include <array>

#include "viewer/gl/gl_objects.h"
#include "viewer/mesh/figure_mesh.h"
#include "viewer/stage/stage_look.h"

namespace dance {

// A program with the places of what is set for each draw call.
struct FigureProgram {
  GlProgram program;
  GLint first = -1;
  GLint stride = -1;
  GLint morph_weights = -1;
  GLint without_head = -1;
};

class FigurePrograms {
 public:
  static constexpr int kPictureUnit = 1;
  static constexpr int kFiguresUnit = 2;
  static constexpr int kMorphsUnit = 3;
  static constexpr std::size_t kCount = 2 * 2 * 3 * 3;

  explicit FigurePrograms(Quality quality) : quality_(quality) {}

  // A figure that fades out needs a program of its own: one that leaves out pixels is slower.
  static std::size_t index_of(const FigureBatch& batch, bool is_fading);
  static std::size_t shadow_index_of(const FigureBatch& batch, bool is_fading);
  Result<void> link(const FigureBatch& batch, bool is_fading);

  // Linked before.
  const FigureProgram& lit(std::size_t index) const { return lit_[index]; }
  const FigureProgram& shadow(std::size_t index) const { return shadow_[index]; }
  bool has_lit(std::size_t index) const { return static_cast<bool>(lit_[index].program); }

 private:
  Quality quality_;
  std::array<FigureProgram, kCount> lit_;
  std::array<FigureProgram, 2 * 6> shadow_;
};

}  // namespace dance
