#include "headset/stereo/board_painter.h"

namespace dance {
namespace {

constexpr std::string_view kBoardVertex = R"(
uniform mat4 u_clip_from_world;
uniform vec3 u_centre;
uniform vec3 u_right;  // half the width
uniform vec3 u_up;     // half the height
uniform vec3 u_low;    // on the sheet, top left
uniform vec3 u_high;
out vec2 v_uv;
void main() {
  vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  v_uv = mix(u_low.xy, u_high.xy, vec2(at.x, 1.0 - at.y));
  vec3 p = u_centre + (2.0 * at.x - 1.0) * u_right + (2.0 * at.y - 1.0) * u_up;
  gl_Position = u_clip_from_world * vec4(p, 1.0);
}
)";

// The sheet's rows count from its top, a texture's from its bottom.
constexpr std::string_view kBoardFragment = R"(
uniform sampler2D u_sheet;
uniform float u_opacity;
in vec2 v_uv;
out vec4 o_colour;
void main() {
  vec4 seen = texture(u_sheet, vec2(v_uv.x, 1.0 - v_uv.y));
  vec3 straight = seen.a > 0.0 ? seen.rgb / seen.a : vec3(0.0);
  vec3 light = pow(straight, vec3(2.2));
  o_colour = vec4(light * seen.a, seen.a) * u_opacity;
}
)";

constexpr std::string_view kDarkVertex = R"(
void main() {
  vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  gl_Position = vec4(at, 0.0, 1.0);
}
)";

constexpr std::string_view kDarkFragment = R"(
uniform float u_darkness;
out vec4 o_colour;
void main() { o_colour = vec4(0.0, 0.0, 0.0, u_darkness); }
)";

}  // namespace

Result<BoardPainter> BoardPainter::create() {
  BoardPainter painter;
  DANCE_TRY(painter.board_, link_program("board", {kBoardVertex}, {kBoardFragment}));
  DANCE_TRY(painter.dark_, link_program("darkness", {kDarkVertex}, {kDarkFragment}));
  return painter;
}

void BoardPainter::draw(const StageEye& eye, std::span<const Board> boards,
                        const GlTexture& sheet) {
  if (boards.empty()) return;
  glUseProgram(board_.name());
  set_uniform(board_, "u_clip_from_world", eye.clip_from_world);
  set_uniform(board_, "u_sheet", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, sheet.name());
  glBindVertexArray(no_vertices_.name());
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const Board& board : boards) {
    if (board.opacity <= 0.0f) continue;
    set_uniform(board_, "u_centre", board.centre_W_m);
    set_uniform(board_, "u_right", Eigen::Vector3f(0.5f * board.width_m * board.axes_W.col(0)));
    set_uniform(board_, "u_up", Eigen::Vector3f(0.5f * board.height_m * board.axes_W.col(1)));
    set_uniform(board_, "u_low", Eigen::Vector3f(board.u0, board.v0, 0.0f));
    set_uniform(board_, "u_high", Eigen::Vector3f(board.u1, board.v1, 0.0f));
    set_uniform(board_, "u_opacity", board.opacity);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  check_gl("BoardPainter::draw");
}

void BoardPainter::darken(float darkness) {
  if (darkness <= 0.0f) return;
  glUseProgram(dark_.name());
  set_uniform(dark_, "u_darkness", darkness);
  glBindVertexArray(no_vertices_.name());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace dance
