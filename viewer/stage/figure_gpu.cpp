#include "viewer/stage/figure_gpu.h"

#include <algorithm>
#include <span>

namespace dance {
namespace {

constexpr std::size_t kMaterialBytes = sizeof(FigureMaterial) * kMaterialsOfGroup;

std::size_t bytes_of(const AvatarPicture& picture, int most_px) {
  auto width = static_cast<std::size_t>(picture.width_px);
  auto height = static_cast<std::size_t>(picture.height_px);
  while (std::max(width, height) > static_cast<std::size_t>(most_px)) {
    width = std::max<std::size_t>(1, width / 2);
    height = std::max<std::size_t>(1, height / 2);
  }
  return width * height * 4 * 4 / 3;  // with its mipmaps
}

// The mean of four pixels, so that fine patterns stay.
AvatarPicture halved(const AvatarPicture& from) {
  AvatarPicture to;
  to.width_px = std::max(1, from.width_px / 2);
  to.height_px = std::max(1, from.height_px / 2);
  to.rgba.resize(std::size_t{4} * static_cast<std::size_t>(to.width_px) *
                 static_cast<std::size_t>(to.height_px));
  std::size_t out = 0;
  for (int y = 0; y < to.height_px; ++y)
    for (int x = 0; x < to.width_px; ++x)
      for (std::size_t part = 0; part < 4; ++part) {
        int sum = 0;
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          const int fx = std::min(2 * x + dx, from.width_px - 1);
          const int fy = std::min(2 * y + dy, from.height_px - 1);
          const std::size_t pixel =
              static_cast<std::size_t>(fy) * static_cast<std::size_t>(from.width_px) +
              static_cast<std::size_t>(fx);
          sum += from.rgba[4 * pixel + part];
        }
        to.rgba[out++] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
  return to;
}

GlTexture upload_picture(const AvatarPicture& picture) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, picture.width_px, picture.height_px, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, picture.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 4.0f);
  return texture;
}

template <class Items>
void upload(GLenum target, const GlBuffer& buffer, const Items& items) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(std::span(items).size_bytes()), items.data(),
               GL_STATIC_DRAW);
}

std::size_t level_vertices(const FigureMesh& mesh, bool is_coarse) {
  return is_coarse ? mesh.levels.back().vertex_count : mesh.vertices.size();
}
// Those of the coarsest level are the first.
std::size_t level_indices(const FigureMesh& mesh, bool is_coarse) {
  return is_coarse ? std::size_t{3} * mesh.levels.back().triangle_count : mesh.indices.size();
}

}  // namespace

std::size_t gpu_bytes(const AvatarModel& model, const FigureMesh& mesh,
                      const FigureLimits& limits) {
  std::size_t bytes = level_vertices(mesh, limits.is_coarse) * sizeof(FigureVertex) +
                      level_indices(mesh, limits.is_coarse) * sizeof(std::uint32_t) +
                      mesh.materials.size() * sizeof(FigureMaterial) + kMaterialBytes;
  if (!limits.is_coarse) bytes += mesh.morph_steps.size() * sizeof(MorphStep);
  for (const AvatarPicture& picture : model.pictures)
    bytes += bytes_of(picture, limits.most_picture_px);
  return bytes;
}

FigureGpu::FigureGpu(const AvatarModel& model, const FigureMesh& mesh, const FigureLimits& limits)
    : bytes_(gpu_bytes(model, mesh, limits)),
      array_(GlVertexArray::make()),
      vertices_(GlBuffer::make()),
      indices_(GlBuffer::make()),
      materials_(GlBuffer::make()) {
  shape_.batches = mesh.batches;
  shape_.levels = mesh.levels;
  if (limits.is_coarse) shape_.levels = {mesh.levels.back()};
  glBindVertexArray(array_.name());
  upload(GL_ARRAY_BUFFER, vertices_,
         std::span(mesh.vertices).first(level_vertices(mesh, limits.is_coarse)));
  upload(GL_ELEMENT_ARRAY_BUFFER, indices_,
         std::span(mesh.indices).first(level_indices(mesh, limits.is_coarse)));
  describe_vertices();
  glBindVertexArray(0);
  upload_materials(mesh);
  if (!limits.is_coarse) upload_morphs(mesh);
  upload_pictures(model, limits.most_picture_px);
  check_gl("FigureGpu");
}

void FigureGpu::describe_vertices() {
  constexpr GLsizei kStride = sizeof(FigureVertex);
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(FigureVertex, place_m)));
  glVertexAttribPointer(1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, kStride,
                        at(offsetof(FigureVertex, normal)));
  glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(FigureVertex, uv)));
  glVertexAttribIPointer(3, 4, GL_UNSIGNED_SHORT, kStride, at(offsetof(FigureVertex, joints)));
  glVertexAttribPointer(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                        at(offsetof(FigureVertex, weights)));
  glVertexAttribIPointer(5, 1, GL_UNSIGNED_INT, kStride, at(offsetof(FigureVertex, material)));
  glVertexAttribIPointer(6, 1, GL_UNSIGNED_INT, kStride, at(offsetof(FigureVertex, morphs)));
  for (GLuint attribute = 0; attribute < 7; ++attribute) glEnableVertexAttribArray(attribute);
}

// Whole groups, as a uniform block is bound whole.
void FigureGpu::upload_materials(const FigureMesh& mesh) {
  const std::size_t groups = mesh.materials.size() / kMaterialsOfGroup + 1;
  glBindBuffer(GL_UNIFORM_BUFFER, materials_.name());
  glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(groups * kMaterialBytes), nullptr,
               GL_STATIC_DRAW);
  glBufferSubData(GL_UNIFORM_BUFFER, 0,
                  static_cast<GLsizeiptr>(mesh.materials.size() * sizeof(FigureMaterial)),
                  mesh.materials.data());
}

void FigureGpu::upload_morphs(const FigureMesh& mesh) {
  GLint most_texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most_texels);
  // Two texels for each. A card with less room shows a face that does not move.
  if (mesh.morph_steps.empty() ||
      2 * mesh.morph_steps.size() > static_cast<std::size_t>(most_texels))
    return;
  morph_buffer_ = GlBuffer::make();
  upload(GL_TEXTURE_BUFFER, morph_buffer_, mesh.morph_steps);
  morphs_ = GlTexture::make();
  glBindTexture(GL_TEXTURE_BUFFER, morphs_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA16F, morph_buffer_.name());
}

void FigureGpu::upload_pictures(const AvatarModel& model, int most_px) {
  GLint card_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &card_px);
  for (const AvatarPicture& picture : model.pictures) {
    const AvatarPicture* fits = &picture;
    AvatarPicture smaller;
    while (std::max(fits->width_px, fits->height_px) > std::min(most_px, card_px)) {
      smaller = halved(*fits);
      fits = &smaller;
    }
    pictures_.push_back(upload_picture(*fits));
  }
}

void FigureGpu::bind(int morph_unit) const {
  glBindVertexArray(array_.name());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(morph_unit));
  glBindTexture(GL_TEXTURE_BUFFER, morphs_.name());
}

void FigureGpu::bind_batch(std::size_t batch, int picture_unit) const {
  const FigureBatch& what = shape_.batches[batch];
  glBindBufferRange(GL_UNIFORM_BUFFER, 0, materials_.name(),
                    static_cast<GLintptr>(what.material_group * kMaterialBytes), kMaterialBytes);
  if (what.picture < 0) return;
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(picture_unit));
  glBindTexture(GL_TEXTURE_2D, pictures_[static_cast<std::size_t>(what.picture)].name());
}

void FigureGpu::draw_batch(std::size_t batch, std::size_t level, GLsizei figures) const {
  const FigureLevel::Range& range = shape_.levels[level].batches[batch];
  if (range.index_count == 0) return;
  glDrawElementsInstanced(
      GL_TRIANGLES, static_cast<GLsizei>(range.index_count), GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(std::size_t{range.first_index} * sizeof(std::uint32_t)),
      figures);
}

}  // namespace dance
