#include "viewer/stage/shader/stage_shaders.h"

namespace dance::shaders {

// A key light with soft shadow from one side, a hemisphere that fills, and a rim that lifts bodies
// off the backdrop. Their colours come from StageMood.
const std::string_view kLight = R"(
uniform vec3 u_eye;
uniform vec3 u_to_light;
uniform mat4 u_light_from_world;
uniform float u_penumbra;  // share of the shadow map
uniform sampler2DShadow u_shadow;
uniform vec3 u_key;
uniform vec3 u_sky;
uniform vec3 u_bounce;
uniform vec3 u_rim;

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
  vec3 fill = mix(u_bounce, u_sky, 0.5 + 0.5 * n.y) * ambient_open;
  // A second, weak light from behind the key's other side keeps forms round in the shade.
  vec3 back = vec3(-u_to_light.x, 0.35, -u_to_light.z);
  fill += 0.16 * vec3(0.9, 0.95, 1.1) * max(dot(n, normalize(back)), 0.0);
  vec3 h = normalize(u_to_light + v);
  float sharp = mix(12.0, 90.0, gloss);
  float glint = gloss * key * pow(max(dot(n, h), 0.0), sharp);
  float rim = pow(1.0 - max(dot(n, v), 0.0), 3.0) * smoothstep(-0.4, 0.6, n.y);
  return albedo * (u_key * key + fill) + u_key * 0.6 * glint + u_rim * (0.06 + 0.25 * albedo) * rim;
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

}  // namespace dance::shaders
