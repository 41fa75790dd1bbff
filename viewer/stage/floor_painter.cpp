#include "viewer/stage/floor_painter.h"

#include <cmath>

#include "viewer/stage/shader/stage_shaders.h"

namespace dance {

using Eigen::Matrix4f;
using Eigen::Vector3f;

namespace {

constexpr float kRingBegins_m = 0.35f;
constexpr float kRingRuns_m = 2.2f;  // in a beat
constexpr float kOfOtherBeats = 0.55f;
constexpr float kOfAGlow = 0.5f;
constexpr float kWaitingRadius_m = 0.5f;
// The pool of light round an area, and where, in its radii, the shader lets the floor end.
constexpr float kRoundArea_m = 1.6f;
constexpr float kEndsAtPools = 2.1f;

}  // namespace

float pool_of(const StageArea& area) { return area.radius_m + kRoundArea_m; }

float radius_of_floor_that_ends_at(float ends_m) { return ends_m / kEndsAtPools - kRoundArea_m; }

BeatPulse pulse_of(const SceneMusic& music) {
  const double beat = std::floor(music.beats);
  const auto phase = static_cast<float>(music.beats - beat);
  const bool is_one = music.beats_per_bar > 0 && std::fmod(beat, music.beats_per_bar) == 0.0;
  const float strength = is_one ? 1.0f : kOfOtherBeats;
  return {kRingBegins_m + kRingRuns_m * (1.0f - (1.0f - phase) * (1.0f - phase)),
          strength * (1.0f - phase) * (1.0f - phase),
          kOfAGlow * strength * std::exp(-5.0f * phase)};
}

Result<FloorPainter> FloorPainter::create(Quality quality) {
  using namespace shaders;
  FloorPainter painter(quality);
  const bool is_high = quality == Quality::kHigh;
  const std::string_view taps = is_high ? kManyTaps : kFewTaps;
  const std::string_view plain = is_high ? "#define IS_PLAIN 0\n" : "#define IS_PLAIN 1\n";
  DANCE_TRY(painter.floor_, link_program("floor", {kFloorVertex},
                                         {taps, plain, kLight, kFloorDetail, kFloorFragment}));
  DANCE_TRY(painter.spot_, link_program("spot", {kSpotVertex}, {kSpotFragment}));
  DANCE_TRY(painter.waiting_, link_program("waiting", {kSpotVertex}, {kWaitingFragment}));
  return painter;
}

FloorPainter::FloorPainter(Quality quality)
    : quality_(quality),
      no_vertices_(GlVertexArray::make()),
      spot_array_(GlVertexArray::make()),
      spot_buffer_(GlBuffer::make()) {
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

void FloorPainter::draw_floor(const StageLight& light, const Matrix4f& clip_from_world,
                              const Vector3f& eye_W_m, const StageArea& area,
                              const BeatPulse& pulse) {
  light.use(floor_, eye_W_m);
  set_uniform(floor_, "u_clip_from_world", clip_from_world);
  set_uniform(floor_, "u_centre", area.centre_W_m);
  set_uniform(floor_, "u_pool", pool_of(area));
  set_uniform(floor_, "u_reflect", quality_ == Quality::kHigh ? 1.0f : 0.6f);
  set_uniform(floor_, "u_pulse", Vector3f(pulse.radius_m, pulse.ring, pulse.glow));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
}

void FloorPainter::upload(std::span<const ContactSpot> spots) {
  glBindVertexArray(spot_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, spot_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(spots.size_bytes()), spots.data(),
               GL_STREAM_DRAW);
}

// Spots lie in the floor's own plane and so leave depth alone; they are drawn before what stands
// on it.
void FloorPainter::draw_spots(const Matrix4f& clip_from_world, std::span<const ContactSpot> spots) {
  if (spots.empty()) return;
  upload(spots);
  glUseProgram(spot_.name());
  set_uniform(spot_, "u_clip_from_world", clip_from_world);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(spots.size()));
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
}

void FloorPainter::draw_waiting(const Matrix4f& clip_from_world,
                                std::span<const WaitingGuest> guests) {
  if (guests.empty()) return;
  glUseProgram(waiting_.name());
  set_uniform(waiting_, "u_clip_from_world", clip_from_world);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  for (const WaitingGuest& guest : guests) {
    rings_.assign(1, {Vector3f(guest.place_W_m.x(), 0.0f, guest.place_W_m.z()), kWaitingRadius_m,
                      Vector3f::UnitX(), kWaitingRadius_m, guest.opacity});
    upload(rings_);
    set_uniform(waiting_, "u_colour", guest.colour);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 1);
  }
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
}

}  // namespace dance
