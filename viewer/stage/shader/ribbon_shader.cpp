#include "viewer/stage/shader/stage_shaders.h"

namespace dance::shaders {

// A trail: its edges are computed beside; the middle glows, its end fades.
const std::string_view kRibbonVertex = R"(
layout(location = 0) in vec4 a_place;   // W, across: -1..1
layout(location = 1) in vec4 a_colour;  // rgb, strength
uniform mat4 u_clip_from_world;
out float v_across;
out vec4 v_colour;
void main() {
  v_across = a_place.w;
  v_colour = a_colour;
  gl_Position = u_clip_from_world * vec4(a_place.xyz, 1.0);
}
)";

const std::string_view kRibbonFragment = R"(
in float v_across;
in vec4 v_colour;
out vec4 o_colour;
void main() {
  float soft = 1.0 - v_across * v_across;
  o_colour = vec4(v_colour.rgb, v_colour.a * soft * soft);
}
)";

}  // namespace dance::shaders
