#include "viewer/stage/figure_programs.h"

#include <string>

#include "viewer/stage/shader/stage_shaders.h"

namespace dance {
namespace {

std::string definitions(const FigureBatch& batch, bool is_fading, Quality quality) {
  const auto define = [](const char* name, int value) {
    return "#define " + std::string(name) + " " + std::to_string(value) + "\n";
  };
  const bool is_high = quality == Quality::kHigh;
  return define("HAS_PICTURE", batch.picture >= 0) +
         define("ALPHA", static_cast<int>(batch.alpha_mode)) +
         define("SHADING", static_cast<int>(batch.shading)) + define("HAS_SAMPLES", is_high) +
         define("IS_FADING", is_fading) + define("JOINTS_OF_A_VERTEX", is_high ? 4 : 2);
}

void find_places(FigureProgram& made) {
  const GLuint name = made.program.name();
  made.first = glGetUniformLocation(name, "u_first");
  made.stride = glGetUniformLocation(name, "u_stride");
  made.morph_weights = glGetUniformLocation(name, "u_morph_weights");
  made.without_head = glGetUniformLocation(name, "u_without_head");
  glUseProgram(name);
  set_uniform(made.program, "u_picture", FigurePrograms::kPictureUnit);
  set_uniform(made.program, "u_figures", FigurePrograms::kFiguresUnit);
  set_uniform(made.program, "u_morphs", FigurePrograms::kMorphsUnit);
  const GLuint block = glGetUniformBlockIndex(name, "Materials");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(name, block, 0);
}

}  // namespace

std::size_t FigurePrograms::index_of(const FigureBatch& batch, bool is_fading) {
  return (is_fading ? 18u : 0u) + 9u * (batch.picture >= 0 ? 1u : 0u) +
         3u * static_cast<std::size_t>(batch.alpha_mode) + static_cast<std::size_t>(batch.shading);
}
std::size_t FigurePrograms::shadow_index_of(const FigureBatch& batch, bool is_fading) {
  const std::size_t first = is_fading ? 6 : 0;
  if (batch.alpha_mode == AlphaMode::kOpaque) return first;
  return first + 3u * (batch.picture >= 0 ? 1u : 0u) + static_cast<std::size_t>(batch.alpha_mode);
}

Result<void> FigurePrograms::link(const FigureBatch& batch, bool is_fading) {
  using namespace shaders;
  const std::string defined = definitions(batch, is_fading, quality_);
  FigureProgram& lit = lit_[index_of(batch, is_fading)];
  if (!lit.program) {
    const std::string_view taps = quality_ == Quality::kHigh ? kManyTaps : kFewTaps;
    DANCE_TRY(lit.program, link_program("figure", {defined, kFigureSkin, kFigureVertex},
                                        {defined, taps, kLight, kFigureFragment}));
    find_places(lit);
  }
  FigureProgram& shadow = shadow_[shadow_index_of(batch, is_fading)];
  if (!shadow.program) {
    DANCE_TRY(shadow.program,
              link_program("figure's shadow", {defined, kFigureSkin, kFigureShadowVertex},
                           {defined, kFigureShadowFragment}));
    find_places(shadow);
  }
  return {};
}

}  // namespace dance
