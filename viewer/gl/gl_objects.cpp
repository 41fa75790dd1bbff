#include "viewer/gl/gl_objects.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace dance {
namespace {

constexpr std::string_view kVersionLine = "#version 330 core\n";

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// Deletes itself when linking is over; the program keeps what it needs.
class Shader {
 public:
  explicit Shader(GLenum stage) : name_(glCreateShader(stage)) {}
  ~Shader() { glDeleteShader(name_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  Result<void> compile(std::string_view program, std::initializer_list<std::string_view> pieces) {
    std::vector<const char*> texts{kVersionLine.data()};
    std::vector<GLint> lengths{static_cast<GLint>(kVersionLine.size())};
    for (const std::string_view piece : pieces) {
      texts.push_back(piece.data());
      lengths.push_back(static_cast<GLint>(piece.size()));
    }
    glShaderSource(name_, static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
    glCompileShader(name_);
    GLint compiled = GL_FALSE;
    glGetShaderiv(name_, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return {};
    std::array<char, 1024> log{};
    glGetShaderInfoLog(name_, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return fail("the graphics driver refuses the shader '" + std::string(program) +
                "': " + first_line(log.data()));
  }
  GLuint name() const { return name_; }

 private:
  GLuint name_;
};

GLint location(const GlProgram& program, const char* name) {
  return glGetUniformLocation(program.name(), name);
}

}  // namespace

Result<GlProgram> link_program(std::string_view name,
                               std::initializer_list<std::string_view> vertex,
                               std::initializer_list<std::string_view> fragment) {
  Shader vertex_shader(GL_VERTEX_SHADER);
  Shader fragment_shader(GL_FRAGMENT_SHADER);
  if (auto compiled = vertex_shader.compile(name, vertex); !compiled)
    return fail(compiled.error().what);
  if (auto compiled = fragment_shader.compile(name, fragment); !compiled)
    return fail(compiled.error().what);

  GlProgram program = GlProgram::make();
  glAttachShader(program.name(), vertex_shader.name());
  glAttachShader(program.name(), fragment_shader.name());
  glLinkProgram(program.name());
  glDetachShader(program.name(), vertex_shader.name());
  glDetachShader(program.name(), fragment_shader.name());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return fail("the graphics driver cannot link the shader '" + std::string(name) +
              "': " + first_line(log.data()));
}

void set_uniform(const GlProgram& program, const char* name, const Eigen::Matrix4f& value) {
  glUniformMatrix4fv(location(program, name), 1, GL_FALSE, value.data());
}
void set_uniform(const GlProgram& program, const char* name, const Eigen::Vector3f& value) {
  glUniform3fv(location(program, name), 1, value.data());
}
void set_uniform(const GlProgram& program, const char* name, const Eigen::Vector4f& value) {
  glUniform4fv(location(program, name), 1, value.data());
}
void set_uniform(const GlProgram& program, const char* name, float value) {
  glUniform1f(location(program, name), value);
}
void set_uniform(const GlProgram& program, const char* name, int value) {
  glUniform1i(location(program, name), value);
}

void check_gl([[maybe_unused]] const char* where) {
#ifndef NDEBUG
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  std::fprintf(stderr, "OpenGL error 0x%04x in %s\n", error, where);
  std::abort();
#endif
}

}  // namespace dance
