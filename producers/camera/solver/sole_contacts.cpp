#include "producers/camera/solver/sole_contacts.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3d;

namespace {

// `dance capture solve eval` tuned these.
constexpr double kStandsBelow_m_s = 0.25, kGoesAbove_m_s = 0.5;
constexpr double kStandsUnder_m = 0.045, kGoesOver_m = 0.07;
constexpr double kGone_m = 0.05;
constexpr double kSpeedOver_s = 0.05;
// A foot that has just come down may still settle. After that, one that is seen elsewhere is
// followed imperceptibly slowly.
constexpr double kSettles_s = 0.12, kSettleOver_s = 0.06, kFollowSole_s = 1.5,
                 kMostFollow_m_s = 0.01;
constexpr double kHiddenTimeout_s = 0.3;

struct Share {
  Landmark left;
  double share;
};
// The landmarks that place a sole.
constexpr Share kOfHeel[]{{Landmark::kLeftHeel, 0.6}, {Landmark::kLeftAnkle, 0.4}};
constexpr Share kOfBall[]{
    {Landmark::kLeftFootIndex, 0.5}, {Landmark::kLeftAnkle, 0.3}, {Landmark::kLeftHeel, 0.2}};

}  // namespace

void SoleContacts::clear() { soles_.fill(Foot()); }

void SoleContacts::follow(const BodyModel& body, const Observation& seen,
                          const CameraPlacement& camera, double seconds) {
  double low = 1e9;
  for (std::size_t i = 0; i < kSoleCount; ++i)
    low = std::min(low, body.point(kLandmarkCount + i).y());
  const double floor = camera.is_known() ? 0.0 : low;
  const Eigen::Matrix3d& R_WC = camera.R_WC();
  for (std::size_t i = 0; i < kSoleCount; ++i) {
    Foot& sole = soles_[i];
    const std::size_t side = i / 2;
    // The foot's residual in the picture, at the body's depth.
    Vector3d off_C = Vector3d::Zero();
    double weight = 0.0;
    const auto look = [&](const Share& share) {
      const std::size_t point = index_of(share.left) + side;
      const Vector3d p = camera.to_C(body.point(point));
      const double w = share.share * seen.weight[point];
      off_C.x() += w * (seen.ray[point].x() * p.z() - p.x());
      off_C.y() += w * (seen.ray[point].y() * p.z() - p.y());
      weight += w;
    };
    if (i % 2 == 0)
      for (const Share& share : kOfHeel) look(share);
    else
      for (const Share& share : kOfBall) look(share);
    if (weight < 0.15) {
      sole.hidden_s += seconds;
      if (sole.hidden_s > kHiddenTimeout_s) sole.touch.stands = false;
      continue;
    }
    sole.hidden_s = 0.0;
    const Vector3d own_C = camera.to_C(body.point(kLandmarkCount + i));
    const Vector3d place = body.point(kLandmarkCount + i) + R_WC * off_C / weight;
    // Across the view only: a picture does not show speed along it.
    const Eigen::Vector2d ray = (own_C + off_C / weight).head<2>() / own_C.z();
    if (sole.is_new || !(seconds > 0.0)) {
      sole.velocity.setConstant(kGoesAbove_m_s);
    } else {
      const Eigen::Vector2d velocity = own_C.z() / seconds * (ray - sole.ray);
      sole.velocity += (velocity - sole.velocity) * (1.0 - std::exp(-seconds / kSpeedOver_s));
    }
    sole.ray = ray;
    sole.is_new = false;
    sole.seen_W_m = place;
    const double height = place.y() - floor, speed = sole.velocity.norm();
    if (!sole.touch.stands) {
      sole.touch.stands = height < kStandsUnder_m && speed < kStandsBelow_m_s;
      sole.touch.held_W_m = body.point(kLandmarkCount + i);
      sole.touch.stands_for_s = 0.0;
    } else {
      Vector3d off = place - sole.touch.held_W_m;
      off.y() = 0.0;
      sole.touch.stands = height < kGoesOver_m && speed < kGoesAbove_m_s && off.norm() < kGone_m;
      sole.touch.stands_for_s += seconds;
      if (sole.touch.stands_for_s < kSettles_s) {
        sole.touch.held_W_m += off * (1.0 - std::exp(-seconds / kSettleOver_s));
      } else {
        const double speed_m_s = std::min(off.norm() / kFollowSole_s, kMostFollow_m_s);
        if (off.norm() > 1e-6) sole.touch.held_W_m += off.normalized() * (speed_m_s * seconds);
      }
    }
    sole.touch.held_W_m.y() = 0.0;
  }
}

}  // namespace dance
