#include "viewer/stage/shaders.h"

namespace dance::shaders {

// A key light with soft shadow from one side, a hemisphere that fills, and a rim that lifts bodies
// off the backdrop. Colours and strengths were chosen by eye.
const std::string_view kLight = R"(
uniform vec3 u_eye;
uniform vec3 u_to_light;
uniform mat4 u_light_from_world;
uniform float u_penumbra;  // share of the shadow map
uniform sampler2DShadow u_shadow;

const vec3 kKey = vec3(1.50, 1.34, 1.12);
const vec3 kSky = vec3(0.42, 0.46, 0.55);
const vec3 kBounce = vec3(0.30, 0.22, 0.16);
const vec3 kRim = vec3(0.55, 0.62, 0.80);

// Vogel's disk: taps evenly spread over the penumbra.
float lit_by_key(vec3 p, vec3 n) {
  vec4 q = u_light_from_world * vec4(p + 0.02 * n, 1.0);
  vec3 s = 0.5 * q.xyz + 0.5;
  if (any(lessThan(s, vec3(0.0))) || any(greaterThan(s, vec3(1.0)))) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < SHADOW_TAPS; ++i) {
    float r = sqrt((float(i) + 0.5) / float(SHADOW_TAPS));
    float a = 2.399963 * float(i);
    sum += texture(u_shadow, vec3(s.xy + u_penumbra * r * vec2(cos(a), sin(a)), s.z - 0.0012));
  }
  return sum / float(SHADOW_TAPS);
}

vec3 shade(vec3 albedo, vec3 p, vec3 n, float gloss, float ambient_open) {
  vec3 v = normalize(u_eye - p);
  float facing = dot(n, u_to_light);
  float key = facing > 0.0 ? facing * lit_by_key(p, n) : 0.0;
  vec3 fill = mix(kBounce, kSky, 0.5 + 0.5 * n.y) * ambient_open;
  // A second, weak light from behind the key's other side keeps forms round in the shade.
  vec3 back = vec3(-u_to_light.x, 0.35, -u_to_light.z);
  fill += 0.16 * vec3(0.9, 0.95, 1.1) * max(dot(n, normalize(back)), 0.0);
  vec3 h = normalize(u_to_light + v);
  float sharp = mix(12.0, 90.0, gloss);
  float glint = gloss * key * pow(max(dot(n, h), 0.0), sharp);
  float rim = pow(1.0 - max(dot(n, v), 0.0), 3.0) * smoothstep(-0.4, 0.6, n.y);
  return albedo * (kKey * key + fill) + kKey * 0.6 * glint + kRim * (0.06 + 0.25 * albedo) * rim;
}

// Darker overhead, with a warm glow low down; the same below the horizon, as the floor mirrors it.
vec3 backdrop(vec3 direction) {
  float h = abs(normalize(direction).y);
  vec3 low = vec3(0.105, 0.070, 0.072);
  vec3 middle = vec3(0.050, 0.047, 0.072);
  vec3 high = vec3(0.010, 0.012, 0.024);
  return mix(mix(low, middle, smoothstep(0.0, 0.22, h)), high, smoothstep(0.12, 0.75, h));
}
)";

// Two balls and their hull. The hull touches ball a (and b) on the circle of elevation φ above its
// equator, sin φ = (r_a − r_b)/|b − a|, so a's mesh covers −π/2..φ and b's covers φ..π/2.
const std::string_view kPartShape = R"(
layout(location = 0) in vec4 a_vertex;  // cos and sin of longitude, share of the arc, end
layout(location = 1) in vec4 i_a;       // p_W, radius
layout(location = 2) in vec4 i_b;
layout(location = 3) in vec4 i_side;    // direction in W, width
layout(location = 4) in vec4 i_colour;  // rgb, gloss
layout(location = 5) in vec4 i_form;    // flat_a, flat_b, depth, opacity

void part_point(out vec3 p, out vec3 n) {
  vec3 axis = i_b.xyz - i_a.xyz;
  float len = length(axis);
  vec3 y = axis / len;
  vec3 x = i_side.xyz - y * dot(i_side.xyz, y);
  if (dot(x, x) < 1e-6) x = abs(y.x) < 0.7 ? cross(y, vec3(1, 0, 0)) : cross(y, vec3(0, 0, 1));
  x = normalize(x);
  vec3 z = cross(x, y);
  float phi = asin(clamp((i_a.w - i_b.w) / len, -0.98, 0.98));
  bool at_b = a_vertex.w > 0.5;
  float theta = at_b ? mix(phi, 1.5707963, a_vertex.z) : mix(-1.5707963, phi, a_vertex.z);
  float c = cos(theta);
  float s = sin(theta);
  vec2 round_ = c * a_vertex.xy;
  float radius = at_b ? i_b.w : i_a.w;
  float press = at_b ? i_form.y : i_form.x;
  p = (at_b ? i_b.xyz : i_a.xyz) +
      radius * (x * round_.x * i_side.w + y * s * press + z * round_.y * i_form.z);
  n = normalize(x * round_.x / i_side.w + y * s + z * round_.y / i_form.z);
}
)";

const std::string_view kBodyVertex = R"(
uniform mat4 u_clip_from_world;
uniform float u_mirror;  // 1, or −1 for the mirror image under the floor
out vec3 v_p;
out vec3 v_n;
out vec4 v_colour;
flat out float v_opacity;
void main() {
  part_point(v_p, v_n);
  v_p.y *= u_mirror;
  v_n.y *= u_mirror;
  v_colour = i_colour;
  v_opacity = i_form.w;
  gl_ClipDistance[0] = u_mirror < 0.0 ? -v_p.y : 1.0;
  gl_Position = u_clip_from_world * vec4(v_p, 1.0);
}
)";

const std::string_view kBodyFragment = R"(
uniform float u_mirror;
in vec3 v_p;
in vec3 v_n;
in vec4 v_colour;
flat in float v_opacity;
out vec4 o_colour;

// A guest that fades out is dithered away: no sorting, and its shadow thins alike.
float threshold(vec2 pixel) {
  return fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
}
void main() {
  if (v_opacity < 1.0 && v_opacity <= threshold(gl_FragCoord.xy)) discard;
  vec3 n = normalize(v_n);
  // The mirror image is lit as the body is.
  vec3 p = vec3(v_p.x, v_p.y * u_mirror, v_p.z);
  vec3 lit_n = vec3(n.x, n.y * u_mirror, n.z);
  float open_ = mix(0.62, 1.0, smoothstep(0.0, 0.5, p.y + 0.25 * max(lit_n.y, 0.0)));
  vec3 colour = shade(v_colour.rgb, p, lit_n, v_colour.a, open_);
  o_colour = vec4(colour, 1.0);
}
)";

const std::string_view kShadowVertex = R"(
uniform mat4 u_light_from_world;
flat out float v_opacity;
void main() {
  vec3 p, n;
  part_point(p, n);
  v_opacity = i_form.w;
  gl_Position = u_light_from_world * vec4(p, 1.0);
}
)";

const std::string_view kShadowFragment = R"(
flat in float v_opacity;
void main() {
  float t = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
  if (v_opacity < 1.0 && v_opacity <= t) discard;
}
)";

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

// Planks of oak with a line every metre; what is too fine for a pixel fades instead of flickering.
const std::string_view kFloorFragment = R"(
uniform vec3 u_centre;
uniform float u_pool;  // radius of the pool of light, m
uniform float u_reflect;
in vec3 v_p;
out vec4 o_colour;

float hash(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }

float line(float x, float period, float half_width) {
  float w = fwidth(x);
  float d = abs(fract(x / period + 0.5) - 0.5) * period;
  float cover = 1.0 - smoothstep(half_width - 0.5 * w, half_width + w, d);
  return cover * clamp(2.0 * half_width / max(w, 1e-5), 0.0, 1.0);
}

void main() {
  vec2 p = v_p.xz;
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
  float grid = max(line(p.x, 1.0, 0.006), line(p.y, 1.0, 0.006));
  wood = mix(wood, vec3(0.62, 0.50, 0.38), 0.22 * grid);

  float r = distance(p, u_centre.xz) / u_pool;
  vec3 colour = shade(wood, v_p, vec3(0.0, 1.0, 0.0), 0.0, 1.0);
  colour *= mix(1.0, 0.42, smoothstep(0.15, 1.3, r));
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
