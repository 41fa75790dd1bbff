#include "viewer/stage/ribbon_painter.h"

#include "viewer/stage/shader/stage_shaders.h"

namespace dance {

Result<RibbonPainter> RibbonPainter::create() {
  RibbonPainter painter;
  DANCE_TRY(painter.program_,
            link_program("ribbon", {shaders::kRibbonVertex}, {shaders::kRibbonFragment}));
  return painter;
}

RibbonPainter::RibbonPainter() : array_(GlVertexArray::make()), buffer_(GlBuffer::make()) {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  for (const GLuint attribute : {0u, 1u}) {
    glVertexAttribPointer(attribute, 4, GL_FLOAT, GL_FALSE, sizeof(RibbonVertex),
                          reinterpret_cast<const void*>(std::uintptr_t{16} * attribute));
    glEnableVertexAttribArray(attribute);
  }
  glBindVertexArray(0);
}

void RibbonPainter::draw(const Eigen::Matrix4f& clip_from_world,
                         std::span<const RibbonVertex> triangles) {
  if (triangles.empty()) return;
  glUseProgram(program_.name());
  set_uniform(program_, "u_clip_from_world", clip_from_world);
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size_bytes()), triangles.data(),
               GL_STREAM_DRAW);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE);  // light: where trails cross it is brighter
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(triangles.size()));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
}

}  // namespace dance
