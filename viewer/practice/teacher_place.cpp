#include "viewer/practice/teacher_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/pose/mirror.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// The other side's bone, by name.
template <std::size_t n>
constexpr std::array<std::size_t, n> other_sides(const std::array<BoneInfo, n>& bones) {
  std::array<std::size_t, n> others{};
  for (std::size_t i = 0; i < n; ++i) {
    others[i] = i;
    for (std::size_t k = 0; k < n; ++k) {
      const std::string_view a = bones[i].name, b = bones[k].name;
      const bool is_pair = (a.starts_with("left") && b.starts_with("right")) ||
                           (a.starts_with("right") && b.starts_with("left"));
      if (is_pair && a.substr(a[0] == 'l' ? 4 : 5) == b.substr(b[0] == 'l' ? 4 : 5)) others[i] = k;
    }
  }
  return others;
}
constexpr auto kOtherBone = other_sides(kBones);
constexpr auto kOtherFinger = other_sides(kFingerBones);
constexpr std::array<std::size_t, kTipCount> kOtherTip{0, 2, 1, 4, 3};

template <class Values, std::size_t n>
Values exchanged(const Values& values, const std::array<std::size_t, n>& others) {
  Values result = values;
  for (std::size_t i = 0; i < n; ++i) result[i] = mirrored(values[others[i]]);
  return result;
}

template <std::size_t n>
std::uint32_t exchanged_bits(std::uint32_t bits, const std::array<std::size_t, n>& others) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < n; ++i)
    if ((bits >> others[i] & 1u) != 0) result |= 1u << i;
  return result;
}

float yaw_of(const SceneGuest& guest) {
  const Vector3f facing = facing_W(guest);
  return std::atan2(facing.x(), facing.z());
}

Quaternionf turn(float yaw_rad) {
  return Quaternionf(Eigen::AngleAxisf(yaw_rad, Vector3f::UnitY()));
}

// On the floor; heights stay.
void move(Pose& pose, const Vector3f& from_m, float yaw_rad, const Vector3f& to_m) {
  const Quaternionf R = turn(yaw_rad);
  const float height_m = pose.p_WH_m.y();
  pose.p_WH_m = R * (pose.p_WH_m - from_m) + to_m;
  pose.p_WH_m.y() = height_m;
  Quaternionf& hips = pose.R_PB[index_of(Bone::kHips)];
  hips = (R * hips).normalized();
}

}  // namespace

double changed_speed(double speed, int steps) {
  const double tenths = std::round(speed / TeacherChoices::kStep) + steps;
  return std::clamp(tenths * TeacherChoices::kStep, TeacherChoices::kSlowest,
                    TeacherChoices::kFastest);
}

void mirror_figure(SceneGuest& figure) {
  figure.skeleton.offset_m = exchanged(figure.skeleton.offset_m, kOtherBone);
  figure.skeleton.tip_m = exchanged(figure.skeleton.tip_m, kOtherTip);
  figure.pose.R_PB = exchanged(figure.pose.R_PB, kOtherBone);
  figure.pose.presence = exchanged_bits(figure.pose.presence, kOtherBone);
  figure.pose.p_WH_m = mirrored(figure.pose.p_WH_m);
  if (!figure.hands) return;
  figure.hands->R_PB = exchanged(figure.hands->R_PB, kOtherFinger);
  figure.hands->presence = exchanged_bits(figure.hands->presence, kOtherFinger);
}

void TeacherPlace::begin(const SceneGuest& recorded) {
  has_begun_ = true;
  has_pupil_ = false;
  p_WFrom_m_ = p_WTo_m_ = recorded.pose.p_WH_m;
  from_rad_ = to_rad_ = yaw_of(recorded);
}

void TeacherPlace::put_beside(const SceneGuest& pupil, bool is_over) {
  has_pupil_ = true;
  to_rad_ = yaw_of(pupil);
  const Vector3f right = turn(to_rad_) * -Vector3f::UnitX();
  p_WTo_m_ = pupil.pose.p_WH_m + (is_over ? 0.0f : kBeside_m) * right;
}

void TeacherPlace::apply(SceneGuest& figure, bool is_mirrored) const {
  move(figure.pose, p_WFrom_m_, -from_rad_, Vector3f::Zero());
  if (is_mirrored) mirror_figure(figure);
  move(figure.pose, Vector3f::Zero(), to_rad_, p_WTo_m_);
}

}  // namespace dance
