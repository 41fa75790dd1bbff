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
constexpr std::uint64_t kKeptPictures = 240;

bool is_high(Quality quality) { return quality == Quality::kHigh; }
int shadow_map_px(Quality quality) { return is_high(quality) ? 2048 : 1024; }

}  // namespace

Result<std::unique_ptr<StageRenderer>> StageRenderer::create(Quality quality) {
  DANCE_TRY(FloorPainter floor, FloorPainter::create(quality));
  DANCE_TRY(PlacePainter place, PlacePainter::create(quality));
  DANCE_TRY(LimbPainter limbs, LimbPainter::create());
  DANCE_TRY(RibbonPainter ribbons, RibbonPainter::create());
  std::unique_ptr<StageRenderer> renderer(new StageRenderer(
      quality, {std::move(floor), std::move(place), std::move(limbs), std::move(ribbons)}));
  if (auto linked = renderer->link_programs(); !linked) return fail(linked.error().what);
  check_gl("StageRenderer::create");
  return renderer;
}

StageRenderer::StageRenderer(Quality quality, Painters painters)
    : quality_(quality),
      target_(is_high(quality) ? kSamples : 0),
      light_(shadow_map_px(quality)),
      figures_(quality),
      floor_(std::move(painters.floor)),
      place_(std::move(painters.place)),
      limb_painter_(std::move(painters.limbs)),
      ribbons_(std::move(painters.ribbons)),
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
  place_.set_breath(look_.pulse ? lamp_breath(scene.music) : 0.0f);
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
                [this](const auto& it) { return it.second.last_used + kKeptPictures < picture_; });
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
  light_.set_mood({});
  if (!has_place()) return;
  place_.show(look_.place, room_around(box));
  light_.set_mood(place_.shape().mood);
  if (!is_high(quality_) && place_.shape().mirror) make_soft_limbs(posed_, limbs_);
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
  glEnable(GL_DEPTH_TEST);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (has_place())
    paint_place(eye);
  else
    paint_plain(eye);
  floor_.draw_spots(clip_from_world, spots_);
  floor_.draw_waiting(clip_from_world, waiting_);
  figures_.draw_solid(light_, clip_from_world, eye.eye_W_m, FigureImage::kNone);
  figures_.draw_blended(light_, clip_from_world, eye.eye_W_m);
  ribbons_.draw(clip_from_world, trail_triangles_);
  if (more) more(eye);
  target_.resolve_light();
  finish_picture();
  check_gl("StageRenderer::paint");
}

void StageRenderer::paint_plain(const StageEye& eye) {
  draw_backdrop(eye);
  if (is_high(quality_))
    figures_.draw_solid(light_, eye.clip_from_world, eye_in_floor(eye).eye_W_m,
                        FigureImage::kInFloor);
  floor_.draw_floor(light_, eye.clip_from_world, eye.eye_W_m, floor_area(), pulse_);
}

// Low quality draws the sky last, so that each pixel is shaded about once.
void StageRenderer::paint_place(const StageEye& eye) {
  const auto mirror = place_.mirror_for(eye);
  if (is_high(quality_)) place_.draw_sky(eye);
  if (is_high(quality_) || mirror) paint_images(eye, mirror);
  place_.draw_solid(eye);
  if (mirror) place_.draw_glass(eye);
  place_.draw_floor(light_, eye, area_, pulse_);
  if (!is_high(quality_)) place_.draw_sky(eye);
  place_.draw_beyond(light_, eye, area_);
  place_.draw_fading(eye);
}

void StageRenderer::paint_images(const StageEye& eye, const std::optional<PlaceMirror>& mirror) {
  place_.begin_mask(eye, is_high(quality_), mirror.has_value());
  if (is_high(quality_)) {
    place_.draw_image(eye_in_floor(eye), false);
    figures_.draw_solid(light_, eye.clip_from_world, eye_in_floor(eye).eye_W_m,
                        FigureImage::kInFloor);
  }
  if (mirror) {
    const StageEye image = eye_in_mirror(eye, *mirror);
    place_.draw_image(image, true);
    if (is_high(quality_))
      figures_.draw_solid(light_, image.clip_from_world, image.eye_W_m, FigureImage::kInMirror);
    else
      limb_painter_.draw(image, limbs_);
  }
  place_.end_mask();
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
