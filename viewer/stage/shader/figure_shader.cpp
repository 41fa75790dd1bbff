#include "viewer/stage/shader/stage_shaders.h"

namespace dance::shaders {

// u_figures has, for each figure: a texel (opacity), three rows of the matrix of each joint, and
// the weights of the morphs, four to a texel. u_morphs has two texels for each step: where it moves
// the place and by which morph, and how it turns the normal.
const std::string_view kFigureSkin = R"(
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec4 a_normal;
layout(location = 2) in vec2 a_uv;
layout(location = 3) in uvec4 a_joints;
layout(location = 4) in vec4 a_weights;
layout(location = 5) in uint a_material;
layout(location = 6) in uint a_morphs;

uniform samplerBuffer u_figures;
uniform samplerBuffer u_morphs;
uniform int u_first;           // texel of the first figure of this call
uniform int u_stride;          // texels of a figure
uniform int u_morph_weights;   // where its weights begin; 0: no morph is on
uniform int u_without_head;

void morph(int figure, inout vec3 place, inout vec3 normal) {
  int step_ = int(a_morphs & 0xffffffu);
  for (int left = int(a_morphs >> 24); left > 0; --left, ++step_) {
    vec4 move = texelFetch(u_morphs, 2 * step_);
    int number = int(move.w);
    float weight = texelFetch(u_figures, figure + u_morph_weights + number / 4)[number % 4];
    place += weight * move.xyz;
    normal += weight * texelFetch(u_morphs, 2 * step_ + 1).xyz;
  }
}

// Returns the opacity.
float figure_vertex(out vec3 p, out vec3 n) {
  int figure = u_first + gl_InstanceID * u_stride;
  vec3 place = a_place;
  vec3 normal = a_normal.xyz;
  if (u_morph_weights != 0) morph(figure, place, normal);
  ivec4 at = figure + 1 + 3 * ivec4(a_joints);
#if JOINTS_OF_A_VERTEX == 4
  vec4 w = a_weights;
#else
  vec2 w = a_weights.xy / max(a_weights.x + a_weights.y, 1e-3);
#endif
  vec4 x = w.x * texelFetch(u_figures, at.x) + w.y * texelFetch(u_figures, at.y);
  vec4 y = w.x * texelFetch(u_figures, at.x + 1) + w.y * texelFetch(u_figures, at.y + 1);
  vec4 z = w.x * texelFetch(u_figures, at.x + 2) + w.y * texelFetch(u_figures, at.y + 2);
#if JOINTS_OF_A_VERTEX == 4
  x += w.z * texelFetch(u_figures, at.z) + w.w * texelFetch(u_figures, at.w);
  y += w.z * texelFetch(u_figures, at.z + 1) + w.w * texelFetch(u_figures, at.w + 1);
  z += w.z * texelFetch(u_figures, at.z + 2) + w.w * texelFetch(u_figures, at.w + 2);
#endif
  vec4 h = vec4(place, 1.0);
  p = vec3(dot(x, h), dot(y, h), dot(z, h));
  n = normalize(vec3(dot(x.xyz, normal), dot(y.xyz, normal), dot(z.xyz, normal)));
  return texelFetch(u_figures, figure).x;
}

// Below 0 where the vertex is not to be seen.
float seen_by_its_own_eyes() {
  return u_without_head != 0 && (a_material & 0x10000u) != 0u ? -1.0 : 1.0;
}
)";

const std::string_view kFigureVertex = R"(
uniform mat4 u_clip_from_world;
uniform float u_mirror;  // 1, or −1 for the mirror image under the floor
out vec3 v_p;
out vec3 v_n;
out vec2 v_uv;
flat out int v_material;
flat out float v_opacity;
void main() {
  v_opacity = figure_vertex(v_p, v_n);
  v_p.y *= u_mirror;
  v_n.y *= u_mirror;
  v_uv = a_uv;
  v_material = int(a_material & 0xffu);
  gl_ClipDistance[0] = u_mirror < 0.0 ? -v_p.y : seen_by_its_own_eyes();
  gl_Position = u_clip_from_world * vec4(v_p, 1.0);
}
)";

const std::string_view kFigureFragment = R"(
struct Material {
  vec4 base;
  vec4 emission;  // rgb, gloss
  vec4 shade;     // rgb, shift
  vec4 toony;     // toony, alpha cutoff
};
layout(std140) uniform Materials { Material u_materials[256]; };
uniform float u_mirror;
uniform sampler2D u_picture;
in vec3 v_p;
in vec3 v_n;
in vec2 v_uv;
flat in int v_material;
flat in float v_opacity;
out vec4 o_colour;

// A guest that fades out is dithered away: no sorting, and its shadow thins alike.
float threshold(vec2 pixel) {
  return fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
}

// Two tones with an edge between, as MToon has them.
vec3 toon(vec3 base, vec3 shade_, float shift, float toony, vec3 p, vec3 n) {
  float facing = dot(n, u_to_light) + shift;
  float edge = max(1.0 - toony, 0.02);
  float lit = clamp((facing + edge) / (2.0 * edge), 0.0, 1.0);
  if (facing > -edge) lit *= lit_by_key(p, n);
  vec3 v = normalize(u_eye - p);
  float rim = pow(1.0 - max(dot(n, v), 0.0), 4.0) * smoothstep(-0.4, 0.6, n.y);
  return mix(shade_ * vec3(0.62, 0.64, 0.72), base * vec3(1.12, 1.06, 0.98), lit) +
         u_rim * (0.03 + 0.12 * base) * rim;
}

void main() {
#if IS_FADING
  if (v_opacity < 1.0 && v_opacity <= threshold(gl_FragCoord.xy)) discard;
#endif
  Material m = u_materials[v_material];
  vec4 base = m.base;
  vec3 shade_colour = m.shade.rgb;
#if HAS_PICTURE
  vec4 texel = texture(u_picture, v_uv);
  base *= texel;
  shade_colour *= texel.rgb;
#endif
  float alpha = 1.0;
#if ALPHA == 1
#if HAS_SAMPLES
  // Its edge over one pixel becomes the share of the samples that are covered.
  alpha = clamp((base.a - m.toony.y) / max(fwidth(base.a), 1e-4) + 0.5, 0.0, 1.0);
  if (alpha <= 0.0) discard;
#else
  if (base.a < m.toony.y) discard;
#endif
#elif ALPHA == 2
  alpha = base.a;
  if (alpha <= 0.004) discard;
#endif
  // The mirror image is lit as the figure is; the back of a sheet as its front.
  vec3 n = normalize(v_n) * (gl_FrontFacing ? 1.0 : -1.0);
  vec3 p = vec3(v_p.x, v_p.y * u_mirror, v_p.z);
  vec3 lit_n = vec3(n.x, n.y * u_mirror, n.z);
#if SHADING == 0
  float open_ = mix(0.62, 1.0, smoothstep(0.0, 0.5, p.y + 0.25 * max(lit_n.y, 0.0)));
  vec3 colour = shade(base.rgb, p, lit_n, m.emission.a, open_);
#elif SHADING == 1
  vec3 colour = toon(base.rgb, shade_colour, m.shade.a, m.toony.x, p, lit_n);
#else
  vec3 colour = base.rgb;
#endif
  o_colour = vec4(colour + m.emission.rgb, alpha);
}
)";

const std::string_view kFigureShadowVertex = R"(
uniform mat4 u_light_from_world;
out vec2 v_uv;
flat out int v_material;
flat out float v_opacity;
void main() {
  vec3 p, n;
  v_opacity = figure_vertex(p, n);
  v_uv = a_uv;
  v_material = int(a_material & 0xffu);
  // Casters have fewer triangles than the surfaces that receive their shadows. Drawn slightly
  // inside, they leave no patches.
  gl_Position = u_light_from_world * vec4(p - 0.012 * n, 1.0);
}
)";

// What is blended casts the shadow of a sieve.
const std::string_view kFigureShadowFragment = R"(
struct Material {
  vec4 base;
  vec4 emission;
  vec4 shade;
  vec4 toony;
};
layout(std140) uniform Materials { Material u_materials[256]; };
uniform sampler2D u_picture;
in vec2 v_uv;
flat in int v_material;
flat in float v_opacity;
void main() {
#if IS_FADING || ALPHA == 2
  float t = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
  float solid = v_opacity;
#endif
#if ALPHA != 0
  float alpha = u_materials[v_material].base.a;
#if HAS_PICTURE
  alpha *= texture(u_picture, v_uv).a;
#endif
#if ALPHA == 1
  if (alpha < u_materials[v_material].toony.y) discard;
#else
  solid *= alpha;
#endif
#endif
#if IS_FADING || ALPHA == 2
  if (solid < 1.0 && solid <= t) discard;
#endif
}
)";

}  // namespace dance::shaders
