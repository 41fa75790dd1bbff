#include "viewer/stage/shader/stage_shaders.h"

namespace dance::shaders {

const std::string_view kFloorVertex = R"(
uniform mat4 u_clip_from_world;
uniform vec3 u_centre;
out vec3 v_p;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  v_p = vec3(u_centre.x + 40.0 * corner.x, 0.0, u_centre.z + 40.0 * corner.y);
  gl_Position = u_clip_from_world * vec4(v_p, 1.0);
}
)";

const std::string_view kFloorDetail = R"(
float hash(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }

float line(float x, float period, float half_width) {
  float w = fwidth(x);
  float d = abs(fract(x / period + 0.5) - 0.5) * period;
  float cover = 1.0 - smoothstep(half_width - 0.5 * w, half_width + w, d);
  return cover * clamp(2.0 * half_width / max(w, 1e-5), 0.0, 1.0);
}
)";

// Planks of oak with a line every metre; what is too fine for a pixel fades instead of flickering.
const std::string_view kFloorFragment = R"(
uniform vec3 u_centre;
uniform float u_pool;  // radius of the pool of light, m
uniform float u_reflect;
uniform vec3 u_pulse;  // radius of the beat's ring in m, its strength, that of the glow
in vec3 v_p;
out vec4 o_colour;

void main() {
  vec2 p = v_p.xz;
#if IS_PLAIN
  vec3 wood = vec3(0.290, 0.150, 0.072);
  float seam = line(p.y, 0.5, 0.004);
  wood *= 1.0 - 0.35 * seam;
#else
  const float kPlankWidth = 0.125;
  const float kPlankLength = 1.6;
  float row = floor(p.y / kPlankWidth);
  float along = p.x + kPlankLength * hash(vec2(row, 3.0));
  vec2 plank = vec2(floor(along / kPlankLength), row);
  float fine = 1.0 - smoothstep(0.02, 0.09, max(fwidth(p.x), fwidth(p.y)));
  float tone = mix(0.5, hash(plank), fine);
  float grain = fine * (hash(vec2(floor(along * 6.0), floor(p.y * 160.0))) - 0.5);
  vec3 wood = mix(vec3(0.250, 0.120, 0.055), vec3(0.360, 0.195, 0.095), tone);
  wood *= 1.0 + 0.05 * grain;
  float seam = max(line(p.y, kPlankWidth, 0.0016), line(along, kPlankLength, 0.0018));
  wood *= 1.0 - 0.55 * seam;
#endif
  float grid = max(line(p.x, 1.0, 0.006), line(p.y, 1.0, 0.006));
  wood = mix(wood, vec3(0.62, 0.50, 0.38), 0.22 * grid);

  float r = distance(p, u_centre.xz) / u_pool;
  vec3 colour = shade(wood, v_p, vec3(0.0, 1.0, 0.0), 0.0, 1.0);
  colour *= mix(1.0, 0.42, smoothstep(0.15, 1.3, r));
  // The beat: a ring that runs outwards, and the pool of light breathes with it.
  float off = distance(p, u_centre.xz) - u_pulse.x;
  float ring = exp(-off * off / (off < 0.0 ? 0.09 : 0.012));
  colour += wood * (vec3(1.5, 1.15, 0.8) * u_pulse.y * ring +
                    vec3(0.9, 0.7, 0.6) * u_pulse.z * (1.0 - smoothstep(0.0, 1.0, r)));
  vec3 v = normalize(u_eye - v_p);
  float mirror = u_reflect * mix(0.10, 0.75, pow(1.0 - v.y, 4.0));
  float fade = 1.0 - smoothstep(0.7, 2.1, r);
  o_colour = vec4(colour, (1.0 - mirror) * fade);
}
)";

const std::string_view kSpotVertex = R"(
layout(location = 0) in vec4 i_centre;  // p_W, half length
layout(location = 1) in vec4 i_along;   // direction in W, half width
layout(location = 2) in float i_darkness;
uniform mat4 u_clip_from_world;
out vec2 v_at;
flat out float v_darkness;
void main() {
  v_at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 across = vec3(-i_along.z, 0.0, i_along.x);
  vec3 p = i_centre.xyz + v_at.x * i_centre.w * i_along.xyz + v_at.y * i_along.w * across;
  v_darkness = i_darkness;
  gl_Position = u_clip_from_world * vec4(p, 1.0);
}
)";

const std::string_view kSpotFragment = R"(
in vec2 v_at;
flat in float v_darkness;
out vec4 o_colour;
void main() {
  float d = min(length(v_at), 1.0);
  float fall = (1.0 - d * d) * (1.0 - d * d);
  o_colour = vec4(vec3(1.0 - v_darkness * fall), 1.0);
}
)";

// Where a guest is whose figure is still being made: a ring of light in the guest's colour.
const std::string_view kWaitingFragment = R"(
uniform vec3 u_colour;
in vec2 v_at;
flat in float v_darkness;
out vec4 o_colour;
void main() {
  float off = (length(v_at) - 0.72) / 0.12;
  float disc = 1.0 - smoothstep(0.0, 0.72, length(v_at));
  o_colour = vec4(v_darkness * u_colour * (exp(-off * off) + 0.25 * disc), 1.0);
}
)";

}  // namespace dance::shaders
