#include "viewer/gl/picture_target.h"

#include <string>

#include "core/base/assert.h"

namespace dance {
namespace {

GlTexture make_texture(GLenum format, int width_px, int height_px) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  const GLenum type = format == GL_RGBA8 ? GL_UNSIGNED_BYTE : GL_HALF_FLOAT;
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width_px, height_px, 0, GL_RGBA, type,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

GlFramebuffer framebuffer_of(const GlTexture& texture) {
  GlFramebuffer framebuffer = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
  return framebuffer;
}

bool is_complete(const GlFramebuffer& framebuffer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

}  // namespace

Result<void> PictureTarget::resize(int width_px, int height_px) {
  DANCE_ASSERT(width_px > 0 && height_px > 0, width_px, height_px);
  if (width_px == width_px_ && height_px == height_px_) return {};
  light_texture_ = make_texture(GL_RGBA16F, width_px, height_px);
  resolved_ = framebuffer_of(light_texture_);
  make_light(width_px, height_px);
  finished_texture_ = make_texture(GL_RGBA8, width_px, height_px);
  finished_ = framebuffer_of(finished_texture_);
  if (!is_complete(light_) || !is_complete(resolved_) || !is_complete(finished_))
    return fail("the graphics driver has no picture of " + std::to_string(width_px) + "x" +
                std::to_string(height_px) + "; choose a smaller --size or --quality low");
  width_px_ = width_px;
  height_px_ = height_px;
  check_gl("PictureTarget");
  return {};
}

void PictureTarget::make_light(int width_px, int height_px) {
  light_ = GlFramebuffer::make();
  depth_ = GlRenderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, GL_DEPTH_COMPONENT24, width_px,
                                   height_px);
  if (samples_ > 0) {
    light_samples_ = GlRenderbuffer::make();
    glBindRenderbuffer(GL_RENDERBUFFER, light_samples_.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, GL_RGBA16F, width_px, height_px);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, light_.name());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
  if (samples_ > 0)
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              light_samples_.name());
  else
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           light_texture_.name(), 0);
}

void PictureTarget::bind_light() const {
  glBindFramebuffer(GL_FRAMEBUFFER, light_.name());
  glViewport(0, 0, width_px_, height_px_);
}

void PictureTarget::resolve_light() const {
  if (samples_ == 0) return;  // it was drawn there
  glBindFramebuffer(GL_READ_FRAMEBUFFER, light_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
  glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px_, height_px_, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

void PictureTarget::bind_finished() const {
  glBindFramebuffer(GL_FRAMEBUFFER, finished_.name());
  glViewport(0, 0, width_px_, height_px_);
}

}  // namespace dance
