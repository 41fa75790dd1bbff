#include "viewer/stage/place/place_painter.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "viewer/stage/shader/stage_shaders.h"

namespace dance {

using Eigen::Matrix4f;
using Eigen::Vector3f;

namespace {

constexpr float kBreathOfLamps = 0.09f;
constexpr float kGlassAlpha = 0.16f;

StageEye image_eye(const StageEye& eye, const Matrix4f& W_from_image) {
  StageEye image = eye;
  image.eye_W_m = (W_from_image * eye.eye_W_m.homogeneous()).head<3>();
  image.view_from_world = eye.view_from_world * W_from_image;
  image.clip_from_world = eye.clip_from_world * W_from_image;
  return image;
}

void add_attribute(GLuint index, GLint size, GLsizei stride, std::uintptr_t offset) {
  glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, stride,
                        reinterpret_cast<const void*>(offset));
  glEnableVertexAttribArray(index);
}

static_assert(sizeof(PlaceVertex) == 28);
static_assert(sizeof(PlaceHalo) == 28);

}  // namespace

float lamp_breath(const std::optional<SceneMusic>& music) {
  if (!music || music->beats_per_bar <= 0 || !std::isfinite(music->beats)) return 0.0f;
  const double bars = music->beats / music->beats_per_bar;
  const auto phase = static_cast<float>(bars - std::floor(bars));
  return kBreathOfLamps * std::cos(2.0f * std::numbers::pi_v<float> * phase);
}

StageEye eye_in_floor(const StageEye& eye) {
  Matrix4f W_from_image = Matrix4f::Identity();
  W_from_image(1, 1) = -1.0f;
  return image_eye(eye, W_from_image);
}

StageEye eye_in_mirror(const StageEye& eye, const PlaceMirror& mirror) {
  Matrix4f W_from_image = Matrix4f::Identity();
  W_from_image(2, 2) = -1.0f;
  W_from_image(2, 3) = 2.0f * mirror.z_m;
  return image_eye(eye, W_from_image);
}

Result<PlacePainter> PlacePainter::create(Quality quality) {
  using namespace shaders;
  PlacePainter painter(quality);
  const bool is_high = quality == Quality::kHigh;
  const std::string_view taps = is_high ? kManyTaps : kFewTaps;
  const std::string_view plain = is_high ? "#define IS_PLAIN 0\n" : "#define IS_PLAIN 1\n";
  DANCE_TRY(painter.walls_, link_program("place", {kPlaceVertex}, {kPlaceFragment}));
  DANCE_TRY(painter.halo_, link_program("halo", {kHaloVertex}, {kHaloFragment}));
  DANCE_TRY(painter.planks_, link_program("planks", {kPlaceFloorVertex},
                                          {taps, plain, "#define IS_TILES 0\n", kLight,
                                           kFloorDetail, kPlaceFloorFragment}));
  DANCE_TRY(painter.tiles_, link_program("tiles", {kPlaceFloorVertex},
                                         {taps, plain, "#define IS_TILES 1\n", kLight, kFloorDetail,
                                          kPlaceFloorFragment}));
  DANCE_TRY(painter.sky_, link_program("sky", {kSkyVertex}, {kSkyFragment}));
  return painter;
}

PlacePainter::PlacePainter(Quality quality)
    : quality_(quality),
      no_vertices_(GlVertexArray::make()),
      array_(GlVertexArray::make()),
      buffer_(GlBuffer::make()),
      corners_(GlBuffer::make()),
      halo_array_(GlVertexArray::make()),
      halo_buffer_(GlBuffer::make()) {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  add_attribute(0, 3, sizeof(PlaceVertex), 0);
  add_attribute(1, 4, sizeof(PlaceVertex), 12);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, corners_.name());
  glBindVertexArray(0);
}

void PlacePainter::show(Venue place, const PlaceRoom& room) {
  if (shape_.place == place && shape_.room == room) return;
  shape_ = make_place(place, room);
  std::vector<GLuint> corners;
  for (GLuint i = 0; i < shape_.vertices.size(); i += 4)
    corners.insert(corners.end(), {i, i + 1, i + 2, i, i + 2, i + 3});
  glBindVertexArray(array_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(GLuint)),
               corners.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(shape_.vertices.size() * sizeof(PlaceVertex)),
               shape_.vertices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, halo_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(shape_.halos.size() * sizeof(PlaceHalo)),
               shape_.halos.data(), GL_STATIC_DRAW);
}

std::optional<PlaceMirror> PlacePainter::mirror_for(const StageEye& eye) const {
  if (!shape_.mirror || eye.eye_W_m.z() <= shape_.mirror->z_m) return std::nullopt;
  return shape_.mirror;
}

// The depth is the nearest everywhere, and the farthest in the mask: depth tests pass only there.
void PlacePainter::begin_mask(const StageEye& eye, bool floor, bool mirror) const {
  glClearDepth(0.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  glClearDepth(1.0);
  begin_walls(eye, 1.0f);
  glDepthFunc(GL_ALWAYS);
  glDepthRange(1.0, 1.0);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  for (const PlaceGroup& group : shape_.groups)
    if ((floor && group.kind == PlaceGroup::Kind::kFloor) ||
        (mirror && group.kind == PlaceGroup::Kind::kGlass))
      draw(group);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthRange(0.0, 1.0);
  glDepthFunc(GL_LESS);
}

void PlacePainter::end_mask() const { glClear(GL_DEPTH_BUFFER_BIT); }

void PlacePainter::begin_walls(const StageEye& eye, float alpha) const {
  glUseProgram(walls_.name());
  set_uniform(walls_, "u_clip_from_world", eye.clip_from_world);
  set_uniform(walls_, "u_tint", Vector3f(Vector3f::Ones()));
  set_uniform(walls_, "u_breath", breath_);
  set_uniform(walls_, "u_alpha", alpha);
  glBindVertexArray(array_.name());
}

void PlacePainter::draw(const PlaceGroup& group) const {
  const auto first = static_cast<GLuint>(group.first);
  const auto end = static_cast<GLuint>(group.first + group.count);
  glDrawRangeElements(GL_TRIANGLES, first, end - 1, static_cast<GLsizei>(group.count / 4 * 6),
                      GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(group.first / 4 * 6 * sizeof(GLuint)));
}

void PlacePainter::draw_solid(const StageEye& eye) const {
  begin_walls(eye, 1.0f);
  for (const PlaceGroup& group : shape_.groups)
    if (group.kind == PlaceGroup::Kind::kSolid && opacity_for(shape_, group, eye.eye_W_m) >= 1.0f)
      draw(group);
}

void PlacePainter::draw_glass(const StageEye& eye) const {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  begin_walls(eye, kGlassAlpha);
  for (const PlaceGroup& group : shape_.groups)
    if (group.kind == PlaceGroup::Kind::kGlass && opacity_for(shape_, group, eye.eye_W_m) > 0.0f)
      draw(group);
  glDisable(GL_BLEND);
}

// Fading parts write no depth, so that they never hide a dancer.
void PlacePainter::draw_fading(const StageEye& eye) const {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  begin_walls(eye, 1.0f);
  glDepthMask(GL_FALSE);
  for (const PlaceGroup& group : shape_.groups) {
    const float opacity = opacity_for(shape_, group, eye.eye_W_m);
    if (group.kind != PlaceGroup::Kind::kSolid || opacity <= 0.0f || opacity >= 1.0f) continue;
    set_uniform(walls_, "u_alpha", opacity);
    draw(group);
  }
  for (const PlaceGroup& group : shape_.groups)
    draw_halos(eye, group, opacity_for(shape_, group, eye.eye_W_m));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void PlacePainter::draw_halos(const StageEye& eye, const PlaceGroup& group, float strength) const {
  if (group.halo_count == 0 || strength <= 0.0f) return;
  glUseProgram(halo_.name());
  set_uniform(halo_, "u_clip_from_world", eye.clip_from_world);
  set_uniform(halo_, "u_right", Vector3f(eye.view_from_world.block<1, 3>(0, 0).transpose()));
  set_uniform(halo_, "u_up", Vector3f(eye.view_from_world.block<1, 3>(1, 0).transpose()));
  set_uniform(halo_, "u_strength", strength * (1.0f + breath_));
  glBindVertexArray(halo_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, halo_buffer_.name());
  const std::uintptr_t first = group.first_halo * sizeof(PlaceHalo);
  add_attribute(0, 4, sizeof(PlaceHalo), first);
  add_attribute(1, 3, sizeof(PlaceHalo), first + 16);
  glVertexAttribDivisor(0, 1);
  glVertexAttribDivisor(1, 1);
  glDisable(GL_CULL_FACE);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(group.halo_count));
  glEnable(GL_CULL_FACE);
}

void PlacePainter::draw_image(const StageEye& image, bool has_floor) const {
  glFrontFace(GL_CW);
  begin_walls(image, 1.0f);
  for (const PlaceGroup& group : shape_.groups)
    if (group.kind == PlaceGroup::Kind::kSolid && group.side != PlaceSide::kFar &&
        opacity_for(shape_, group, image.eye_W_m) > 0.0f)
      draw(group);
  if (has_floor) {
    set_uniform(walls_, "u_tint", Vector3f(1.8f * (shape_.floor.light + shape_.floor.dark) * 0.5f));
    for (const PlaceGroup& group : shape_.groups)
      if (group.kind == PlaceGroup::Kind::kFloor) draw(group);
  }
  glFrontFace(GL_CCW);
}

const GlProgram& PlacePainter::begin_floor(const StageLight& light, const StageEye& eye,
                                           const StageArea& area) const {
  const PlaceFloor& floor = shape_.floor;
  const GlProgram& program = floor.pattern == FloorPattern::kTiles ? tiles_ : planks_;
  light.use(program, eye.eye_W_m);
  set_uniform(program, "u_clip_from_world", eye.clip_from_world);
  set_uniform(program, "u_centre", area.centre_W_m);
  set_uniform(program, "u_pool", pool_of(area));
  set_uniform(program, "u_breath", breath_);
  set_uniform(program, "u_reflect", floor.polish);
  set_uniform(program, "u_wood_light", floor.light);
  set_uniform(program, "u_wood_dark", floor.dark);
  set_uniform(program, "u_sheen", floor.sheen);
  const PlaceRoom& room = shape_.room;
  set_uniform(program, "u_room",
              Eigen::Vector4f(room.left_m, room.right_m, room.back_m, room.front_m));
  glBindVertexArray(array_.name());
  return program;
}

void PlacePainter::draw_floor(const StageLight& light, const StageEye& eye, const StageArea& area,
                              const BeatPulse& pulse) const {
  const GlProgram& program = begin_floor(light, eye, area);
  set_uniform(program, "u_pulse", Vector3f(pulse.radius_m, pulse.ring, pulse.glow));
  set_uniform(program, "u_alpha", 1.0f);
  // Low quality draws no mirror image below the floor, so the floor is opaque.
  if (quality_ == Quality::kHigh) glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  for (const PlaceGroup& group : shape_.groups)
    if (group.kind == PlaceGroup::Kind::kFloor) draw(group);
  glDisable(GL_BLEND);
}

void PlacePainter::draw_beyond(const StageLight& light, const StageEye& eye,
                               const StageArea& area) const {
  const GlProgram& program = begin_floor(light, eye, area);
  set_uniform(program, "u_pulse", Vector3f(0.0f, 0.0f, 0.0f));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  for (const PlaceGroup& group : shape_.groups) {
    const float opacity = opacity_for(shape_, group, eye.eye_W_m);
    if (group.kind != PlaceGroup::Kind::kApron || opacity >= 1.0f) continue;
    set_uniform(program, "u_alpha", 1.0f - opacity);
    draw(group);
  }
  glDisable(GL_BLEND);
}

void PlacePainter::draw_sky(const StageEye& eye) const {
  glUseProgram(sky_.name());
  set_uniform(sky_, "u_world_from_clip", Matrix4f(eye.clip_from_world.inverse()));
  set_uniform(sky_, "u_eye", eye.eye_W_m);
  set_uniform(sky_, "u_low", shape_.sky.low);
  set_uniform(sky_, "u_middle", shape_.sky.middle);
  set_uniform(sky_, "u_high", shape_.sky.high);
  set_uniform(sky_, "u_ground", shape_.sky.ground);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

}  // namespace dance
