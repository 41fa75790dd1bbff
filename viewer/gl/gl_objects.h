// OpenGL names that delete themselves, and the few calls that make programs, textures and targets
// out of them.
//
// Ownership: each object owns its OpenGL name; movable, not copyable. The context must outlive it.
// Threads:   the one whose context is current.
// Failure:   link_program() returns the first line of the driver's log; check_gl() is armed in
//            debug builds and aborts on an OpenGL error, as those are our bugs.
#pragma once

#include <epoxy/gl.h>

#include <Eigen/Core>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "core/base/result.h"

namespace dance {

enum class GlKind { kBuffer, kVertexArray, kTexture, kRenderbuffer, kFramebuffer, kProgram };

template <GlKind kKind>
class GlObject {
 public:
  GlObject() = default;
  ~GlObject() { reset(); }
  GlObject(GlObject&& o) noexcept : name_(std::exchange(o.name_, 0)) {}
  GlObject& operator=(GlObject&& o) noexcept {
    std::swap(name_, o.name_);
    return *this;
  }

  static GlObject make() {
    GlObject object;
    if constexpr (kKind == GlKind::kBuffer) glGenBuffers(1, &object.name_);
    if constexpr (kKind == GlKind::kVertexArray) glGenVertexArrays(1, &object.name_);
    if constexpr (kKind == GlKind::kTexture) glGenTextures(1, &object.name_);
    if constexpr (kKind == GlKind::kRenderbuffer) glGenRenderbuffers(1, &object.name_);
    if constexpr (kKind == GlKind::kFramebuffer) glGenFramebuffers(1, &object.name_);
    if constexpr (kKind == GlKind::kProgram) object.name_ = glCreateProgram();
    return object;
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  void reset() {
    if (name_ == 0) return;
    if constexpr (kKind == GlKind::kBuffer) glDeleteBuffers(1, &name_);
    if constexpr (kKind == GlKind::kVertexArray) glDeleteVertexArrays(1, &name_);
    if constexpr (kKind == GlKind::kTexture) glDeleteTextures(1, &name_);
    if constexpr (kKind == GlKind::kRenderbuffer) glDeleteRenderbuffers(1, &name_);
    if constexpr (kKind == GlKind::kFramebuffer) glDeleteFramebuffers(1, &name_);
    if constexpr (kKind == GlKind::kProgram) glDeleteProgram(name_);
    name_ = 0;
  }

  GLuint name_ = 0;
};

using GlBuffer = GlObject<GlKind::kBuffer>;
using GlVertexArray = GlObject<GlKind::kVertexArray>;
using GlTexture = GlObject<GlKind::kTexture>;
using GlRenderbuffer = GlObject<GlKind::kRenderbuffer>;
using GlFramebuffer = GlObject<GlKind::kFramebuffer>;
using GlProgram = GlObject<GlKind::kProgram>;

// A program from the pieces of its two shaders, each preceded by the version line. `name` is for
// the error.
Result<GlProgram> link_program(std::string_view name,
                               std::initializer_list<std::string_view> vertex,
                               std::initializer_list<std::string_view> fragment);

void set_uniform(const GlProgram& program, const char* name, const Eigen::Matrix4f& value);
void set_uniform(const GlProgram& program, const char* name, const Eigen::Vector3f& value);
void set_uniform(const GlProgram& program, const char* name, const Eigen::Vector4f& value);
void set_uniform(const GlProgram& program, const char* name, float value);
void set_uniform(const GlProgram& program, const char* name, int value);

// Aborts on a pending OpenGL error in debug builds; costs nothing in others.
void check_gl(const char* where);

}  // namespace dance
