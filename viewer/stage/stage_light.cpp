#include "viewer/stage/stage_light.h"

#include <cmath>

#include "viewer/scene/camera.h"

namespace dance {
namespace {

constexpr float kPitch_rad = 0.92f;
constexpr float kBesideCamera_rad = -0.75f;
constexpr float kPenumbra_m = 0.035f;

}  // namespace

StageLight::StageLight(int map_px)
    : map_px_(map_px), map_(GlTexture::make()), target_(GlFramebuffer::make()) {
  glBindTexture(GL_TEXTURE_2D, map_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, map_px, map_px, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map_.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  set_yaw(OrbitCamera().yaw_rad);
}

void StageLight::set_yaw(float yaw_rad) {
  const float yaw = yaw_rad + kBesideCamera_rad;
  to_light_W_ = Eigen::Vector3f(std::sin(yaw) * std::cos(kPitch_rad), std::sin(kPitch_rad),
                                std::cos(yaw) * std::cos(kPitch_rad));
}

void StageLight::shine_on(const Eigen::Vector3f& centre_W_m, float radius_m) {
  radius_m_ = radius_m;
  light_from_world_ = light_clip_from_world(to_light_W_, centre_W_m, radius_m, map_px_);
}

void StageLight::begin_map() const {
  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glViewport(0, 0, map_px_, map_px_);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 3.0f);
}

void StageLight::end_map() const { glDisable(GL_POLYGON_OFFSET_FILL); }

void StageLight::use(const GlProgram& program, const Eigen::Vector3f& eye_W_m) const {
  glUseProgram(program.name());
  glActiveTexture(GL_TEXTURE0 + kUnit);
  glBindTexture(GL_TEXTURE_2D, map_.name());
  set_uniform(program, "u_eye", eye_W_m);
  set_uniform(program, "u_to_light", to_light_W_);
  set_uniform(program, "u_key", mood_.key);
  set_uniform(program, "u_sky", mood_.sky);
  set_uniform(program, "u_bounce", mood_.bounce);
  set_uniform(program, "u_rim", mood_.rim);
  set_uniform(program, "u_light_from_world", light_from_world_);
  set_uniform(program, "u_penumbra", kPenumbra_m / (2.0f * radius_m_));
  set_uniform(program, "u_shadow", kUnit);
}

}  // namespace dance
