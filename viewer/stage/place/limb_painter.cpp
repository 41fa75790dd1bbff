#include "viewer/stage/place/limb_painter.h"

#include <algorithm>

#include "formats/body/guest_look.h"
#include "viewer/stage/shader/stage_shaders.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kUsualLeg_m = 0.86f;
constexpr float kLit = 0.75f;  // brightness on the side that the mirror shows

static_assert(sizeof(SoftLimb) == 44);

void append_soft_limbs(const PosedFigure& figure, std::vector<SoftLimb>& limbs) {
  const BodyFrames& frames = figure.frames;
  const GuestLook look = look_of(figure.id);
  const auto at = [&](Bone bone) -> const Vector3f& { return frames.position(bone); };
  const float leg_m = (at(Bone::kLeftUpperLeg) - at(Bone::kLeftLowerLeg)).norm() +
                      (at(Bone::kLeftLowerLeg) - at(Bone::kLeftFoot)).norm();
  const float scale = leg_m / kUsualLeg_m;
  const auto add = [&](const Vector3f& from, const Vector3f& to, float radius_m,
                       const Vector3f& colour) {
    limbs.push_back({from, scale * radius_m, to, figure.opacity, kLit * colour});
  };
  const auto join = [&](Bone from, Bone to, float radius_m, const Vector3f& colour) {
    add(at(from), at(to), radius_m, colour);
  };
  for (const Limb& leg : {kLeftLeg, kRightLeg}) {
    join(leg.upper, leg.lower, 0.095f, look.legs);
    join(leg.lower, leg.end, 0.07f, look.legs);
  }
  join(Bone::kLeftFoot, Bone::kLeftToes, 0.06f, look.shoes);
  join(Bone::kRightFoot, Bone::kRightToes, 0.06f, look.shoes);
  join(Bone::kHips, Bone::kSpine, 0.15f, look.legs);
  join(Bone::kSpine, Bone::kNeck, 0.17f, look.top);
  join(Bone::kLeftUpperArm, Bone::kRightUpperArm, 0.09f, look.top);
  for (const Limb& arm : {kLeftArm, kRightArm}) {
    join(arm.upper, arm.lower, 0.055f, look.top);
    join(arm.lower, arm.end, 0.05f, look.skin);
  }
  const Vector3f up = frames.R_WB[index_of(Bone::kHead)] * Vector3f::UnitY();
  add(at(Bone::kHead), at(Bone::kHead) + 0.10f * scale * up, 0.105f, look.skin);
  const Vector3f back = frames.R_WB[index_of(Bone::kHead)] * Vector3f(0.0f, 0.13f, -0.03f);
  add(at(Bone::kHead) + scale * back, at(Bone::kHead) + scale * (back + 0.01f * up), 0.105f,
      look.hair);
}

}  // namespace

void make_soft_limbs(std::span<const PosedFigure> figures, std::vector<SoftLimb>& limbs) {
  limbs.clear();
  std::vector<const PosedFigure*> order;
  for (const PosedFigure& figure : figures) order.push_back(&figure);
  const auto z = [](const PosedFigure* it) { return it->frames.position(Bone::kHips).z(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const PosedFigure* a, const PosedFigure* b) { return z(a) > z(b); });
  for (const PosedFigure* figure : order) append_soft_limbs(*figure, limbs);
}

Result<LimbPainter> LimbPainter::create() {
  LimbPainter painter;
  DANCE_TRY(painter.program_,
            link_program("limb", {shaders::kLimbVertex}, {shaders::kLimbFragment}));
  return painter;
}

LimbPainter::LimbPainter() : array_(GlVertexArray::make()), buffer_(GlBuffer::make()) {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  const auto attribute = [](GLuint index, GLint size, std::uintptr_t offset) {
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(SoftLimb),
                          reinterpret_cast<const void*>(offset));
    glEnableVertexAttribArray(index);
    glVertexAttribDivisor(index, 1);
  };
  attribute(0, 4, 0);
  attribute(1, 4, 16);
  attribute(2, 3, 32);
  glBindVertexArray(0);
}

void LimbPainter::draw(const StageEye& eye, std::span<const SoftLimb> limbs) const {
  if (limbs.empty()) return;
  glUseProgram(program_.name());
  set_uniform(program_, "u_clip_from_world", eye.clip_from_world);
  set_uniform(program_, "u_eye", eye.eye_W_m);
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(limbs.size_bytes()), limbs.data(),
               GL_STREAM_DRAW);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(limbs.size()));
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
}

}  // namespace dance
