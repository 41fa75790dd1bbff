#include "viewer/stage/shader/stage_shaders.h"

namespace dance::shaders {

// The vertices contain the light; u_breath is the relative change of the lamps' brightness.
const std::string_view kPlaceVertex = R"(
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec4 a_colour;  // rgb, share of the lamps
uniform mat4 u_clip_from_world;
uniform vec3 u_tint;
uniform float u_breath;
out vec3 v_colour;
void main() {
  v_colour = u_tint * a_colour.rgb * (1.0 + u_breath * a_colour.a);
  gl_Position = u_clip_from_world * vec4(a_place, 1.0);
}
)";

const std::string_view kPlaceFragment = R"(
uniform float u_alpha;
in vec3 v_colour;
out vec4 o_colour;
void main() { o_colour = vec4(v_colour, u_alpha); }
)";

const std::string_view kHaloVertex = R"(
layout(location = 0) in vec4 i_place;   // p_W, radius
layout(location = 1) in vec3 i_colour;
uniform mat4 u_clip_from_world;
uniform vec3 u_right;
uniform vec3 u_up;
uniform float u_strength;
out vec2 v_at;
flat out vec3 v_colour;
void main() {
  v_at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  v_colour = u_strength * i_colour;
  vec3 p = i_place.xyz + i_place.w * (v_at.x * u_right + v_at.y * u_up);
  gl_Position = u_clip_from_world * vec4(p, 1.0);
}
)";

const std::string_view kHaloFragment = R"(
in vec2 v_at;
flat in vec3 v_colour;
out vec4 o_colour;
void main() {
  float d = min(length(v_at), 1.0);
  float fall = (1.0 - d) * (1.0 - d);
  o_colour = vec4(v_colour * fall * fall, 1.0);
}
)";

// A simplified limb in a mirror: a capsule with a soft edge that faces the eye.
const std::string_view kLimbVertex = R"(
layout(location = 0) in vec4 i_from;    // p_W, radius
layout(location = 1) in vec4 i_to;      // p_W, opacity
layout(location = 2) in vec3 i_colour;
uniform mat4 u_clip_from_world;
uniform vec3 u_eye;
out vec2 v_at;
flat out vec4 v_colour;
flat out float v_half;  // length, in radii
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 along = i_to.xyz - i_from.xyz;
  float length_ = max(length(along), 1e-3);
  along /= length_;
  vec3 middle = 0.5 * (i_from.xyz + i_to.xyz);
  vec3 across = cross(along, u_eye - middle);
  across /= max(length(across), 1e-3);
  float r = i_from.w;
  v_half = 0.5 * length_ / r;
  v_at = vec2(corner.x * (v_half + 1.0), corner.y);
  v_colour = vec4(i_colour, i_to.w);
  gl_Position = u_clip_from_world * vec4(middle + r * (v_at.x * along + v_at.y * across), 1.0);
}
)";

const std::string_view kLimbFragment = R"(
in vec2 v_at;
flat in vec4 v_colour;
flat in float v_half;
out vec4 o_colour;
void main() {
  float d = length(vec2(max(abs(v_at.x) - v_half, 0.0), v_at.y));
  float round_ = 0.55 + 0.45 * sqrt(max(0.0, 1.0 - d * d));
  o_colour = vec4(v_colour.rgb * round_, v_colour.a * (1.0 - smoothstep(0.6, 1.0, d)));
}
)";

const std::string_view kPlaceFloorVertex = R"(
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec4 a_colour;
uniform mat4 u_clip_from_world;
uniform float u_breath;
out vec3 v_p;
out vec3 v_light;
void main() {
  v_p = a_place;
  v_light = a_colour.rgb * (1.0 + u_breath * a_colour.a);
  gl_Position = u_clip_from_world * vec4(a_place, 1.0);
}
)";

const std::string_view kPlaceFloorFragment = R"(
uniform vec3 u_centre;
uniform float u_pool;
uniform vec3 u_pulse;
uniform float u_reflect;
uniform vec3 u_wood_light;
uniform vec3 u_wood_dark;
uniform vec3 u_sheen;
uniform vec4 u_room;   // left, right, back, front
uniform float u_alpha;
in vec3 v_p;
in vec3 v_light;
out vec4 o_colour;

vec3 material(vec2 p) {
#if IS_TILES
  vec2 at = p / 0.6;
  float fine = 1.0 - smoothstep(0.15, 0.5, max(fwidth(at.x), fwidth(at.y)));
  vec3 stone = mix(u_wood_dark, u_wood_light, mix(0.5, hash(floor(at)), fine));
  return stone * (1.0 - 0.45 * max(line(p.x, 0.6, 0.006), line(p.y, 0.6, 0.006)));
#else
  const float kPlankWidth = 0.16;
  const float kPlankLength = 2.1;
  float row = floor(p.y / kPlankWidth);
  float along = p.x + kPlankLength * hash(vec2(row, 3.0));
  float fine = 1.0 - smoothstep(0.03, 0.12, max(fwidth(p.x), fwidth(p.y)));
  float tone = mix(0.5, hash(vec2(floor(along / kPlankLength), row)), fine);
  vec3 wood = mix(u_wood_dark, u_wood_light, tone);
#if IS_PLAIN
  return wood * (1.0 - 0.4 * line(p.y, kPlankWidth, 0.002));
#else
  float grain = fine * (hash(vec2(floor(along * 6.0), floor(p.y * 160.0))) - 0.5);
  float seam = max(line(p.y, kPlankWidth, 0.0018), line(along, kPlankLength, 0.0018));
  return wood * (1.0 + 0.05 * grain) * (1.0 - 0.5 * seam);
#endif
#endif
}

void main() {
  vec2 p = v_p.xz;
  vec3 wood = material(p);
  float r = distance(p, u_centre.xz) / u_pool;
  float key = u_to_light.y * lit_by_key(v_p, vec3(0.0, 1.0, 0.0));
  vec3 colour = wood * (u_key * key * mix(1.0, 0.30, smoothstep(0.2, 1.7, r)) + v_light);
  float off = distance(p, u_centre.xz) - u_pulse.x;
  float ring = exp(-off * off / (off < 0.0 ? 0.09 : 0.012));
  colour += wood * (vec3(1.5, 1.15, 0.8) * u_pulse.y * ring +
                    vec3(0.9, 0.7, 0.6) * u_pulse.z * (1.0 - smoothstep(0.0, 1.0, r)));
  float low = 1.0 - normalize(u_eye - v_p).y;
  low *= low;
  float mirror = u_reflect * mix(0.05, 0.55, low * low);
  vec2 beyond = max(max(u_room.xz - p, p - u_room.yw), vec2(0.0));
  float alpha = u_alpha * (1.0 - smoothstep(0.0, 4.6, length(beyond)));
#if IS_PLAIN
  o_colour = vec4(mix(colour, u_sheen, mirror), alpha);
#else
  o_colour = vec4(colour, (1.0 - mirror) * alpha);
#endif
}
)";

// The sky has the farthest depth, so it covers nothing that is drawn already.
const std::string_view kSkyVertex = R"(
out vec2 v_uv;
void main() {
  v_uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(v_uv * 2.0 - 1.0, 1.0, 1.0);
}
)";

const std::string_view kSkyFragment = R"(
uniform mat4 u_world_from_clip;
uniform vec3 u_eye;
uniform vec3 u_low;
uniform vec3 u_middle;
uniform vec3 u_high;
uniform vec3 u_ground;
in vec2 v_uv;
out vec4 o_colour;
void main() {
  vec4 far_ = u_world_from_clip * vec4(v_uv * 2.0 - 1.0, 1.0, 1.0);
  float h = normalize(far_.xyz / far_.w - u_eye).y;
  vec3 above = mix(mix(u_low, u_middle, smoothstep(0.0, 0.24, h)), u_high,
                   smoothstep(0.14, 0.75, h));
  o_colour = vec4(mix(above, u_ground, smoothstep(0.0, 0.12, -h)), 1.0);
}
)";

}  // namespace dance::shaders
