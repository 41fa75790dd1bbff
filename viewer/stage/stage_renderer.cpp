#include "viewer/stage/stage_renderer.h"

#include <Eigen/LU>
#include <utility>

#include "formats/body/guest_look.h"
#include "viewer/stage/shader/stage_shaders.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr int kSamples = 4;
// Around the guests there is always this much lit floor.
constexpr float kSmallestStage_m = 2.2f;
// A stage that is no longer drawn lets go of its guests' models.
constexpr std::uint64_t kPicturesKept = 240;

bool is_high(Quality quality) { return quality == Quality::kHigh; }
int shadow_map_px(Quality quality) { return is_high(quality) ? 2048 : 1024; }

}  // namespace

Result<std::unique_ptr<StageRenderer>> StageRenderer::create(Quality quality) {
  DANCE_TRY(FloorPainter floor, FloorPainter::create(quality));
  DANCE_TRY(RibbonPainter ribbons, RibbonPainter::create());
  std::unique_ptr<StageRenderer> renderer(
      new StageRenderer(quality, std::move(floor), std::move(ribbons)));
  if (auto linked = renderer->link_programs(); !linked) return fail(linked.error().what);
  check_gl("StageRenderer::create");
  return renderer;
}

StageRenderer::StageRenderer(Quality quality, FloorPainter floor, RibbonPainter ribbons)
    : quality_(quality),
      target_(is_high(quality) ? kSamples : 0),
      light_(shadow_map_px(quality)),
      figures_(quality),
      floor_(std::move(floor)),
      ribbons_(std::move(ribbons)),
      no_vertices_(GlVertexArray::make()),
      area_{Vector3f(0.0f, 0.9f, 0.0f), kSmallestStage_m} {}

Result<void> StageRenderer::link_programs() {
  using namespace shaders;
  const std::string_view taps = is_high(quality_) ? kManyTaps : kFewTaps;
  DANCE_TRY(backdrop_,
            link_program("backdrop", {kScreenVertex}, {taps, kLight, kBackdropFragment}));
  DANCE_TRY(finish_, link_program("finish", {kScreenVertex}, {kFinishFragment}));
  return {};
}

Result<void> StageRenderer::draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                                 int height_px) {
  if (auto prepared = prepare(scene, camera, width_px, height_px); !prepared) return prepared;
  paint();
  return {};
}

Result<void> StageRenderer::prepare(const SceneState& scene, const OrbitCamera& camera,
                                    int width_px, int height_px) {
  return prepare(scene, eye_of(camera, width_px, height_px), width_px, height_px);
}

Result<void> StageRenderer::prepare(const SceneState& scene, const StageEye& eye, int width_px,
                                    int height_px) {
  if (auto sized = target_.resize(width_px, height_px); !sized) return sized;
  Memory& memory = memory_of(look_.stage);
  posed_ = memory.poser.pose(scene);
  if (auto taken = figures_.take(posed_, eye, look_); !taken) return taken;
  gather(scene);
  eye_ = eye;
  pulse_ = look_.pulse && scene.music ? pulse_of(*scene.music) : BeatPulse{};
  trail_triangles_.clear();
  if (look_.trails) {
    memory.trails.add(scene.time, posed_);
    memory.trails.append_ribbons(eye.eye_W_m, trail_triangles_);
  } else {
    memory.trails.clear();
  }
  return {};
}

StageRenderer::Memory& StageRenderer::memory_of(int stage) {
  Memory& memory = memories_[stage];
  memory.last_used = ++picture_;
  std::erase_if(memories_,
                [this](const auto& it) { return it.second.last_used + kPicturesKept < picture_; });
  return memory;
}

void StageRenderer::gather(const SceneState& scene) {
  spots_.clear();
  waiting_.clear();
  const auto wait = [&](const GuestId& id, const Vector3f& hips_W_m, float opacity) {
    waiting_.push_back({hips_W_m, look_of(id).tag, opacity});
  };
  Eigen::AlignedBox3f box;
  for (const SceneGuest& guest : scene.guests) {
    if (guest.opacity <= 0.0f) continue;
    box.extend(guest.pose.p_WH_m);
    if (guest.avatar == nullptr) wait(guest.id, guest.pose.p_WH_m, guest.opacity);
  }
  for (const std::size_t i : figures_.waiting())
    wait(posed_[i].id, posed_[i].frames.position(Bone::kHips), posed_[i].opacity);
  for (const PosedFigure& figure : posed_) append_contact_spots(figure, spots_);
  area_ = {Vector3f(0.0f, 0.9f, 0.0f), kSmallestStage_m};
  if (!box.isEmpty()) area_ = {box.center(), 0.5f * box.diagonal().norm() + kSmallestStage_m};
}

StageArea StageRenderer::floor_area() const {
  if (!look_.floor) return area_;
  const FloorLimit& limit = *look_.floor;
  return {Vector3f(limit.x_m, 0.9f, limit.z_m), radius_of_floor_that_ends_at(limit.ends_m)};
}

void StageRenderer::paint() {
  paint_shadows();
  paint_eye(eye_);
}

void StageRenderer::paint_shadows() {
  light_.shine_on(area_.centre_W_m, area_.radius_m);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  light_.begin_map();
  figures_.draw_shadows(light_.light_from_world());
  light_.end_map();
}

void StageRenderer::paint_eye(const StageEye& eye, const PaintMore& more) {
  const Eigen::Matrix4f& clip_from_world = eye.clip_from_world;
  target_.bind_light();
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_backdrop(eye);
  if (is_high(quality_))
    figures_.draw_solid(light_, clip_from_world, eye.eye_W_m.cwiseProduct(Vector3f(1, -1, 1)),
                        -1.0f);
  floor_.draw_floor(light_, clip_from_world, eye.eye_W_m, floor_area(), pulse_);
  floor_.draw_spots(clip_from_world, spots_);
  floor_.draw_waiting(clip_from_world, waiting_);
  figures_.draw_solid(light_, clip_from_world, eye.eye_W_m, 1.0f);
  figures_.draw_blended(light_, clip_from_world, eye.eye_W_m);
  ribbons_.draw(clip_from_world, trail_triangles_);
  if (more) more(eye);
  target_.resolve_light();
  finish_picture();
  check_gl("StageRenderer::paint");
}

void StageRenderer::draw_backdrop(const StageEye& eye) {
  glDisable(GL_DEPTH_TEST);
  light_.use(backdrop_, eye.eye_W_m);
  set_uniform(backdrop_, "u_world_from_clip", Eigen::Matrix4f(eye.clip_from_world.inverse()));
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

void StageRenderer::finish_picture() {
  target_.bind_finished();
  glDisable(GL_DEPTH_TEST);
  glUseProgram(finish_.name());
  set_uniform(finish_, "u_picture", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, target_.light().name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

}  // namespace dance
