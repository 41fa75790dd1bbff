#include "viewer/stage/shader/stage_shaders.h"

namespace dance::shaders {

const std::string_view kScreenVertex = R"(
out vec2 v_uv;
void main() {
  v_uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(v_uv * 2.0 - 1.0, 0.0, 1.0);
}
)";

const std::string_view kBackdropFragment = R"(
uniform mat4 u_world_from_clip;
in vec2 v_uv;
out vec4 o_colour;
void main() {
  vec4 far_ = u_world_from_clip * vec4(v_uv * 2.0 - 1.0, 1.0, 1.0);
  o_colour = vec4(backdrop(far_.xyz / far_.w - u_eye), 1.0);
}
)";

const std::string_view kFinishFragment = R"(
uniform sampler2D u_picture;
in vec2 v_uv;
out vec4 o_colour;
void main() {
  vec3 c = texture(u_picture, v_uv).rgb;
  vec2 d = v_uv - 0.5;
  c *= 1.0 - 0.55 * dot(d, d);
  // Straight up to 0.6, then a shoulder that reaches 1.
  vec3 over = max(c - 0.6, 0.0);
  c = min(c, 0.6) + 0.4 * (1.0 - exp(-over / 0.4));
  vec3 s = mix(12.92 * c, 1.055 * pow(max(c, 1e-5), vec3(1.0 / 2.4)) - 0.055,
               step(0.0031308, c));
  float dither = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  o_colour = vec4(s + (dither - 0.5) / 255.0, 1.0);
}
)";

}  // namespace dance::shaders
