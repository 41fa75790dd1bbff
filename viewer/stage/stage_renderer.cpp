#include "viewer/stage/stage_renderer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "viewer/stage/mannequin.h"
#include "viewer/stage/shaders.h"

namespace dance {

using Eigen::Matrix4f;
using Eigen::Vector3f;

namespace {

constexpr float kLightPitch_rad = 0.92f;
constexpr float kLightBesideCamera_rad = -0.75f;
constexpr float kPenumbra_m = 0.035f;
// Around the guests there is always this much lit floor.
constexpr float kSmallestStage_m = 2.2f;

int shadow_map_px(Quality quality) { return quality == Quality::kHigh ? 2048 : 1024; }
// More are drawn with coarser meshes, as each is small in the picture and all of them cost.
constexpr std::size_t kGuestsDrawnFinely = 8;

bool is_high(Quality quality) { return quality == Quality::kHigh; }

}  // namespace

Result<std::unique_ptr<StageRenderer>> StageRenderer::create(Quality quality) {
  std::unique_ptr<StageRenderer> renderer(new StageRenderer(quality));
  if (auto linked = renderer->link_programs(); !linked) return fail(linked.error().what);
  renderer->make_shadow_map();
  renderer->make_spots();
  check_gl("StageRenderer::create");
  return renderer;
}

StageRenderer::StageRenderer(Quality quality)
    : quality_(quality),
      large_(is_high(quality) ? 24 : 12, is_high(quality) ? 6 : 3),
      large_for_many_(12, 3),
      small_(is_high(quality) ? 10 : 7, is_high(quality) ? 3 : 2),
      target_(is_high(quality) ? 4 : 0),
      no_vertices_(GlVertexArray::make()) {
  set_light_yaw(OrbitCamera().yaw_rad);
}

void StageRenderer::set_light_yaw(float yaw_rad) {
  const float yaw = yaw_rad + kLightBesideCamera_rad;
  to_light_W_ = Vector3f(std::sin(yaw) * std::cos(kLightPitch_rad), std::sin(kLightPitch_rad),
                         std::cos(yaw) * std::cos(kLightPitch_rad));
}

Result<void> StageRenderer::link_programs() {
  using namespace shaders;
  const std::string_view taps = is_high(quality_) ? kManyTaps : kFewTaps;
  DANCE_TRY(body_, link_program("body", {kPartShape, kBodyVertex}, {taps, kLight, kBodyFragment}));
  DANCE_TRY(shadow_, link_program("shadow", {kPartShape, kShadowVertex}, {kShadowFragment}));
  DANCE_TRY(floor_, link_program("floor", {kFloorVertex}, {taps, kLight, kFloorFragment}));
  DANCE_TRY(spot_, link_program("spot", {kSpotVertex}, {kSpotFragment}));
  DANCE_TRY(backdrop_,
            link_program("backdrop", {kScreenVertex}, {taps, kLight, kBackdropFragment}));
  DANCE_TRY(finish_, link_program("finish", {kScreenVertex}, {kFinishFragment}));
  return {};
}

void StageRenderer::make_shadow_map() {
  const int size = shadow_map_px(quality_);
  shadow_map_ = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, shadow_map_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  shadow_target_ = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_map_.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
}

void StageRenderer::make_spots() {
  spot_array_ = GlVertexArray::make();
  spot_buffer_ = GlBuffer::make();
  glBindVertexArray(spot_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, spot_buffer_.name());
  const auto attribute = [](GLuint index, GLint size, std::uintptr_t offset) {
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(ContactSpot),
                          reinterpret_cast<const void*>(offset));
    glEnableVertexAttribArray(index);
    glVertexAttribDivisor(index, 1);
  };
  attribute(0, 4, 0);
  attribute(1, 4, 16);
  attribute(2, 1, 32);
  glBindVertexArray(0);
}

StageRenderer::Stage StageRenderer::gather(const SceneState& scene) {
  parts_.clear();
  Eigen::AlignedBox3f box;
  const bool is_fine = is_high(quality_) && scene.guests.size() <= kGuestsDrawnFinely;
  const BodyDetail detail = is_fine ? BodyDetail::kFine : BodyDetail::kPlain;
  for (const SceneGuest& guest : scene.guests) {
    if (guest.opacity <= 0.0f) continue;
    append_mannequin(guest, detail, parts_);
    box.extend(guest.pose.p_WH_m);
  }
  is_crowded_ = scene.guests.size() > kGuestsDrawnFinely;
  bodies().upload(parts_.large.data(), parts_.large.size());
  small_.upload(parts_.small.data(), parts_.small.size());
  glBindBuffer(GL_ARRAY_BUFFER, spot_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(parts_.spots.size() * sizeof(ContactSpot)),
               parts_.spots.data(), GL_STREAM_DRAW);
  if (box.isEmpty()) return {Vector3f(0.0f, 0.9f, 0.0f), kSmallestStage_m};
  return {box.center(), 0.5f * box.diagonal().norm() + kSmallestStage_m};
}

Result<void> StageRenderer::draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                                 int height_px) {
  if (auto sized = target_.resize(width_px, height_px); !sized) return sized;
  const Stage stage = gather(scene);
  eye_W_m_ = camera.eye_W_m();
  light_radius_m_ = stage.radius_m;
  light_from_world_ =
      light_clip_from_world(to_light_W_, stage.centre_W_m, stage.radius_m, shadow_map_px(quality_));
  const float aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  const Matrix4f clip_from_world = camera.clip_from_world(aspect);

  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  draw_shadow_map();

  target_.bind_light();
  glClear(GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow_map_.name());
  draw_backdrop(clip_from_world);
  if (is_high(quality_)) draw_bodies(clip_from_world, -1.0f);
  draw_floor(clip_from_world, stage);
  draw_spots(clip_from_world);
  draw_bodies(clip_from_world, 1.0f);
  target_.resolve_light();
  finish_picture();
  check_gl("StageRenderer::draw");
  return {};
}

void StageRenderer::draw_shadow_map() {
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.name());
  glViewport(0, 0, shadow_map_px(quality_), shadow_map_px(quality_));
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(shadow_.name());
  set_uniform(shadow_, "u_light_from_world", light_from_world_);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 3.0f);
  bodies().draw();
  small_.draw();
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void StageRenderer::use_lit(const GlProgram& program, const Vector3f& eye_W_m) {
  glUseProgram(program.name());
  set_uniform(program, "u_eye", eye_W_m);
  set_uniform(program, "u_to_light", to_light_W_);
  set_uniform(program, "u_light_from_world", light_from_world_);
  set_uniform(program, "u_penumbra", kPenumbra_m / (2.0f * light_radius_m_));
  set_uniform(program, "u_shadow", 0);
}

void StageRenderer::draw_backdrop(const Matrix4f& clip_from_world) {
  glDisable(GL_DEPTH_TEST);
  use_lit(backdrop_, eye_W_m_);
  set_uniform(backdrop_, "u_world_from_clip", Matrix4f(clip_from_world.inverse()));
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

void StageRenderer::draw_bodies(const Matrix4f& clip_from_world, float mirror) {
  use_lit(body_, mirror > 0.0f ? eye_W_m_ : eye_W_m_.cwiseProduct(Vector3f(1, -1, 1)));
  set_uniform(body_, "u_clip_from_world", clip_from_world);
  set_uniform(body_, "u_mirror", mirror);
  if (mirror < 0.0f) {
    glFrontFace(GL_CW);
    glEnable(GL_CLIP_DISTANCE0);
  }
  bodies().draw();
  small_.draw();
  glDisable(GL_CLIP_DISTANCE0);
  glFrontFace(GL_CCW);
}

void StageRenderer::draw_floor(const Matrix4f& clip_from_world, const Stage& stage) {
  use_lit(floor_, eye_W_m_);
  set_uniform(floor_, "u_clip_from_world", clip_from_world);
  set_uniform(floor_, "u_centre", stage.centre_W_m);
  set_uniform(floor_, "u_pool", stage.radius_m + 1.6f);
  set_uniform(floor_, "u_reflect", is_high(quality_) ? 1.0f : 0.6f);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void StageRenderer::draw_spots(const Matrix4f& clip_from_world) {
  glUseProgram(spot_.name());
  set_uniform(spot_, "u_clip_from_world", clip_from_world);
  // Spots darken what is there; they lie in the floor's own plane and so leave depth alone.
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_FALSE);
  glBindVertexArray(spot_array_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(parts_.spots.size()));
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
}

void StageRenderer::finish_picture() {
  target_.bind_finished();
  glDisable(GL_DEPTH_TEST);
  glUseProgram(finish_.name());
  set_uniform(finish_, "u_picture", 0);
  glBindTexture(GL_TEXTURE_2D, target_.light().name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

}  // namespace dance
