#include "testing/xr/functions/runtime_gl.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h>

#include <cstdio>

namespace dance::test_xr {

bool is_context_current(void* glx_context) {
  if (void* current = glXGetCurrentContext()) return current == glx_context;
  return eglGetCurrentContext() != EGL_NO_CONTEXT;
}

std::vector<std::uint32_t> make_textures(const XrSwapchainCreateInfo& info, std::uint32_t count) {
  std::vector<std::uint32_t> textures(count);
  const bool is_array = info.arraySize > 1;
  const GLenum target = is_array ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  GLint bound = 0;
  glGetIntegerv(is_array ? GL_TEXTURE_BINDING_2D_ARRAY : GL_TEXTURE_BINDING_2D, &bound);
  glGenTextures(static_cast<GLsizei>(count), textures.data());
  const auto format = static_cast<GLint>(info.format);
  const auto width = static_cast<GLsizei>(info.width);
  const auto height = static_cast<GLsizei>(info.height);
  for (const std::uint32_t texture : textures) {
    glBindTexture(target, texture);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    if (is_array)
      glTexImage3D(target, 0, format, width, height, static_cast<GLsizei>(info.arraySize), 0,
                   GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    else
      glTexImage2D(target, 0, format, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  }
  glBindTexture(target, static_cast<GLuint>(bound));
  return textures;
}

void delete_textures(const std::vector<std::uint32_t>& textures) {
  if (textures.empty()) return;
  if (!glXGetCurrentContext() && eglGetCurrentContext() == EGL_NO_CONTEXT) return;
  glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
}

namespace {

// Keeps the application's own framebuffer and packing.
class ReadState {
 public:
  ReadState() {
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer_);
    glGetIntegerv(GL_PACK_ALIGNMENT, &alignment_);
    glGenFramebuffers(1, &own_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, own_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
  }
  ~ReadState() {
    glPixelStorei(GL_PACK_ALIGNMENT, alignment_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
    glDeleteFramebuffers(1, &own_);
  }
  ReadState(const ReadState&) = delete;
  ReadState& operator=(const ReadState&) = delete;

 private:
  GLint framebuffer_ = 0;
  GLint buffer_ = 0;
  GLint alignment_ = 4;
  GLuint own_ = 0;
};

std::vector<std::uint8_t> read_pixels(std::uint32_t texture, const XrSwapchainCreateInfo& info,
                                      const XrSwapchainSubImage& part) {
  const ReadState state;
  if (info.arraySize > 1)
    glFramebufferTextureLayer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0,
                              static_cast<GLint>(part.imageArrayIndex));
  else
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  if (glCheckFramebufferStatus(GL_READ_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return {};
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  const XrRect2Di& rect = part.imageRect;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(rect.extent.width) *
                                   static_cast<std::size_t>(rect.extent.height) * 3);
  glReadPixels(rect.offset.x, rect.offset.y, rect.extent.width, rect.extent.height, GL_RGB,
               GL_UNSIGNED_BYTE, pixels.data());
  return pixels;
}

}  // namespace

bool write_picture(std::uint32_t texture, const XrSwapchainCreateInfo& info,
                   const XrSwapchainSubImage& part, const std::string& path) {
  const std::vector<std::uint8_t> pixels = read_pixels(texture, info, part);
  if (pixels.empty()) return false;
  std::FILE* file = std::fopen(path.c_str(), "wbe");
  if (!file) return false;
  const auto row = static_cast<std::size_t>(part.imageRect.extent.width) * 3;
  std::fprintf(file, "P6\n%d %d\n255\n", part.imageRect.extent.width, part.imageRect.extent.height);
  for (std::size_t end = pixels.size(); end >= row; end -= row)
    std::fwrite(pixels.data() + end - row, 1, row, file);
  return std::fclose(file) == 0;
}

}  // namespace dance::test_xr
