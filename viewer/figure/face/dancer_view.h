// DancerView: the data of each dancer on the stage that faces depend on: positions of eyes, hips
// and palms, directions of head and chest, and whether the steps are on the beat.
//
// Units/frames: metres in W.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/base/guest_id.h"
#include "viewer/figure/figure_fit.h"

namespace dance {

struct DancerView {
  GuestId id;
  Eigen::Vector3f eyes_W_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf R_WH = Eigen::Quaternionf::Identity();  // the head
  Eigen::Vector3f hips_W_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f facing_W = Eigen::Vector3f::UnitZ();  // the chest, on the floor
  std::array<Eigen::Vector3f, 2> palms_W_m{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  float on_beat = 0.0f;  // 0 = off the beat or without music … 1
};

DancerView view_of(const SceneGuest& guest, const FigureFit& fit);

}  // namespace dance
