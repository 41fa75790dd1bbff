#include "viewer/stage/figure_drawer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace dance {
namespace {

constexpr std::size_t kFloatsOfTexel = 4;
constexpr int kTexelsOfJoint = 3;
static_assert(sizeof(JointMatrix) == kTexelsOfJoint * kFloatsOfTexel * sizeof(float));

// A card with less is as slow with more as it is without.
constexpr std::size_t kMostBytesHigh = std::size_t{768} << 20;
constexpr std::size_t kMostBytesLow = std::size_t{256} << 20;

// Triangles for a figure so many pixels tall: about one for every so many pixels of its box.
constexpr double kTrianglesOfPixelHigh = 0.1;
constexpr double kTrianglesOfPixelLow = 0.03;
constexpr double kTrianglesOfShadowHigh = 1500.0;
constexpr float kFigureHeight_m = 1.75f;
constexpr float kNearest_m = 0.2f;

}  // namespace

FigureDrawer::FigureDrawer(Quality quality)
    : quality_(quality),
      store_(quality == Quality::kHigh ? kMostBytesHigh : kMostBytesLow),
      programs_(quality),
      joint_buffer_(GlBuffer::make()),
      joints_(GlTexture::make()) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  most_texels_ = static_cast<std::size_t>(most);
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());
  glBufferData(GL_TEXTURE_BUFFER, sizeof(float) * kFloatsOfTexel, nullptr, GL_STREAM_DRAW);
  glBindTexture(GL_TEXTURE_BUFFER, joints_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, joint_buffer_.name());
}

Result<void> FigureDrawer::take(std::span<const PosedFigure> figures, const StageEye& eye,
                                const StageLook& look) {
  drawn_ = {};
  store_.begin_picture();
  choose(figures, eye, look);
  group(figures);
  for (const Group& group : shadows_)
    for (const FigureBatch& batch : group.gpu->shape().batches)
      if (auto linked = programs_.link(batch, group.is_fading); !linked) return linked;
  upload();
  return {};
}

void FigureDrawer::choose(std::span<const PosedFigure> figures, const StageEye& eye,
                          const StageLook& look) {
  figures_.clear();
  waiting_.clear();
  const Eigen::Matrix4f& view = eye.view_from_world;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    Figure figure;
    figure.index = i;
    figure.gpu = store_.find(figures[i].model);
    if (figure.gpu == nullptr) {
      waiting_.push_back(i);
      continue;
    }
    const Eigen::Vector3f& hips_W_m = figures[i].frames.position(Bone::kHips);
    figure.depth_m = -(view.row(2).head<3>().dot(hips_W_m) + view(2, 3));
    const double height = static_cast<double>(eye.px_at_1m * kFigureHeight_m /
                                              std::max(kNearest_m, std::abs(figure.depth_m)));
    const double of_pixel =
        quality_ == Quality::kHigh ? kTrianglesOfPixelHigh : kTrianglesOfPixelLow;
    figure.level = level_for(figure.gpu->shape(), of_pixel * height * height);
    figure.is_fading = figures[i].opacity < 1.0f;
    figure.is_eye = look.through_eyes_of == figures[i].id;
    figures_.push_back(figure);
  }
  std::sort(figures_.begin(), figures_.end(), [](const Figure& a, const Figure& b) {
    return std::tuple(a.gpu, a.is_fading, a.is_eye, a.level, a.index) <
           std::tuple(b.gpu, b.is_fading, b.is_eye, b.level, b.index);
  });
}

FigureDrawer::Layout FigureDrawer::layout_of(const PosedFigure& figure) {
  Layout layout;
  layout.morph_weights = 1 + kTexelsOfJoint * static_cast<int>(figure.W_from_joint.size());
  layout.stride = layout.morph_weights + static_cast<int>((figure.morph_weights.size() + 3) / 4);
  return layout;
}

void FigureDrawer::write(const PosedFigure& figure, const Layout& layout) {
  const std::size_t begin = texels_.size();
  texels_.resize(begin + static_cast<std::size_t>(layout.stride) * kFloatsOfTexel, 0.0f);
  float* at = texels_.data() + begin;
  at[0] = figure.opacity;
  at += kFloatsOfTexel;
  std::memcpy(at, figure.W_from_joint.data(), figure.W_from_joint.size() * sizeof(JointMatrix));
  at += figure.W_from_joint.size() * kTexelsOfJoint * kFloatsOfTexel;
  std::copy(figure.morph_weights.begin(), figure.morph_weights.end(), at);
}

void FigureDrawer::group(std::span<const PosedFigure> figures) {
  groups_.clear();
  shadows_.clear();
  blended_.clear();
  texels_.clear();
  for (const Figure& chosen : figures_) {
    const PosedFigure& figure = figures[chosen.index];
    const Layout layout = layout_of(figure);
    const auto first = static_cast<int>(texels_.size() / kFloatsOfTexel);
    if (static_cast<std::size_t>(first + layout.stride) > most_texels_) continue;
    write(figure, layout);
    ++drawn_.figures;
    Group one{chosen.gpu, chosen.level,  chosen.is_eye, false, chosen.is_fading, layout, first,
              1,          chosen.depth_m};
    one.has_morphs = chosen.gpu->has_morphs() &&
                     std::any_of(figure.morph_weights.begin(), figure.morph_weights.end(),
                                 [](float weight) { return weight != 0.0f; });
    const auto join = [&](std::vector<Group>& groups, bool is_same) {
      if (!is_same) return groups.push_back(one);
      ++groups.back().count;
      groups.back().has_morphs = groups.back().has_morphs || one.has_morphs;
    };
    const auto goes_with = [&](const std::vector<Group>& groups) {
      return !groups.empty() && groups.back().gpu == one.gpu &&
             groups.back().is_fading == one.is_fading;
    };
    join(shadows_, goes_with(shadows_));
    join(groups_, goes_with(groups_) && groups_.back().level == one.level &&
                      groups_.back().is_eye == one.is_eye);
    const auto& batches = one.gpu->shape().batches;
    if (std::any_of(batches.begin(), batches.end(),
                    [](const FigureBatch& batch) { return batch.alpha_mode == AlphaMode::kBlend; }))
      blended_.push_back(one);
  }
  std::sort(blended_.begin(), blended_.end(),
            [](const Group& a, const Group& b) { return a.depth_m > b.depth_m; });
}

void FigureDrawer::upload() {
  glBindBuffer(GL_TEXTURE_BUFFER, joint_buffer_.name());
  const auto bytes = static_cast<GLsizeiptr>(texels_.size() * sizeof(float));
  if (bytes == 0) return;
  // A new piece of memory, as the card may still read the last picture's.
  glBufferData(GL_TEXTURE_BUFFER, bytes, nullptr, GL_STREAM_DRAW);
  glBufferSubData(GL_TEXTURE_BUFFER, 0, bytes, texels_.data());
}

void FigureDrawer::begin(const FigureProgram& program) const {
  glUseProgram(program.program.name());
  glActiveTexture(GL_TEXTURE0 + FigurePrograms::kFiguresUnit);
  glBindTexture(GL_TEXTURE_BUFFER, joints_.name());
}

bool FigureDrawer::is_shown(const FigureBatch& batch, const Group& group,
                            bool is_seen_by_itself) const {
  if (batch.audience == FirstPerson::kBoth) return true;
  const bool is_own_view = group.is_eye && is_seen_by_itself;
  return (batch.audience == FirstPerson::kFirstPersonOnly) == is_own_view;
}

void FigureDrawer::draw(const FigureProgram& program, const Group& group, std::size_t batch,
                        std::size_t level, bool without_head) {
  glUniform1i(program.first, group.first_texel);
  glUniform1i(program.stride, group.layout.stride);
  glUniform1i(program.morph_weights, group.has_morphs ? group.layout.morph_weights : 0);
  glUniform1i(program.without_head, without_head ? 1 : 0);
  group.gpu->bind(FigurePrograms::kMorphsUnit);
  group.gpu->bind_batch(batch, FigurePrograms::kPictureUnit);
  group.gpu->draw_batch(batch, level, group.count);
  drawn_.triangles += group.gpu->shape().levels[level].batches[batch].index_count / 3 *
                      static_cast<std::size_t>(group.count);
  ++drawn_.calls;
}

void FigureDrawer::draw_shadows(const Eigen::Matrix4f& light_from_world) {
  const FigureProgram* current = nullptr;
  for (const Group& group : shadows_) {
    const std::size_t level = quality_ == Quality::kHigh
                                  ? level_for(group.gpu->shape(), kTrianglesOfShadowHigh)
                                  : group.gpu->coarsest();
    const auto& batches = group.gpu->shape().batches;
    for (std::size_t b = 0; b < batches.size(); ++b) {
      if (!is_shown(batches[b], group, false)) continue;
      const FigureProgram& program =
          programs_.shadow(FigurePrograms::shadow_index_of(batches[b], group.is_fading));
      if (&program != current) {
        begin(program);
        set_uniform(program.program, "u_light_from_world", light_from_world);
        current = &program;
      }
      (batches[b].is_double_sided ? glDisable : glEnable)(GL_CULL_FACE);
      draw(program, group, b, level, false);
    }
  }
  glEnable(GL_CULL_FACE);
}

void FigureDrawer::draw_solid(const StageLight& light, const Eigen::Matrix4f& clip_from_world,
                              const Eigen::Vector3f& eye_W_m, FigureImage image) {
  const bool is_mirror = image != FigureImage::kNone;
  const float mirror = image == FigureImage::kInFloor ? -1.0f : 1.0f;
  glEnable(GL_CLIP_DISTANCE0);
  if (is_mirror) glFrontFace(GL_CW);
  // Program by program, so that what all figures share is set once for each.
  for (std::size_t p = 0; p < FigurePrograms::kCount; ++p) {
    if (!programs_.has_lit(p)) continue;
    const FigureProgram& program = programs_.lit(p);
    bool is_begun = false;
    for (const Group& group : groups_) {
      const auto& batches = group.gpu->shape().batches;
      const std::size_t level =
          is_mirror ? std::min(group.level + 1, group.gpu->coarsest()) : group.level;
      for (std::size_t b = 0; b < batches.size(); ++b) {
        if (batches[b].alpha_mode == AlphaMode::kBlend ||
            !is_shown(batches[b], group, !is_mirror) ||
            FigurePrograms::index_of(batches[b], group.is_fading) != p)
          continue;
        if (!is_begun) {
          begin(program);
          light.use(program.program, eye_W_m);
          set_uniform(program.program, "u_clip_from_world", clip_from_world);
          set_uniform(program.program, "u_mirror", mirror);
          const bool is_masked = batches[b].alpha_mode == AlphaMode::kMask;
          if (is_masked && quality_ == Quality::kHigh) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
          is_begun = true;
        }
        (batches[b].is_double_sided ? glDisable : glEnable)(GL_CULL_FACE);
        draw(program, group, b, level, group.is_eye && !is_mirror);
      }
    }
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  }
  glEnable(GL_CULL_FACE);
  glDisable(GL_CLIP_DISTANCE0);
  glFrontFace(GL_CCW);
}

void FigureDrawer::draw_blended(const StageLight& light, const Eigen::Matrix4f& clip_from_world,
                                const Eigen::Vector3f& eye_W_m) {
  if (blended_.empty()) return;
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const Group& group : blended_) {
    const auto& batches = group.gpu->shape().batches;
    for (std::size_t b = 0; b < batches.size(); ++b) {
      if (batches[b].alpha_mode != AlphaMode::kBlend || !is_shown(batches[b], group, true))
        continue;
      const FigureProgram& program =
          programs_.lit(FigurePrograms::index_of(batches[b], group.is_fading));
      begin(program);
      light.use(program.program, eye_W_m);
      set_uniform(program.program, "u_clip_from_world", clip_from_world);
      set_uniform(program.program, "u_mirror", 1.0f);
      // The far side of a sheet before the near one.
      if (batches[b].is_double_sided) {
        glCullFace(GL_FRONT);
        draw(program, group, b, group.level, group.is_eye);
        glCullFace(GL_BACK);
      }
      draw(program, group, b, group.level, group.is_eye);
    }
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_CLIP_DISTANCE0);
}

}  // namespace dance
