#include "testing/camera/couple_scene.h"

#include <algorithm>
#include <cmath>

#include "testing/camera/limb_joints.h"
#include "testing/camera/sight_line.h"

namespace dance {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;

constexpr double kHold_m = 0.25;
// Of a dancer's joints so many must not be hidden to be detected.
constexpr double kFound = 0.6;
// A dancer who is hidden by more is not told from the one before, unless that one is taken out.
constexpr double kTakenForPartner = 0.4;
const PictureColour kBackground(0.35f, 0.5f, 0.52f);

constexpr Landmark kTrunk[]{Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftHip,
                            Landmark::kRightHip};

}  // namespace

CoupleScene::CoupleScene(const std::array<CoupleDancer, 2>& dancers, double hz, SceneCamera camera,
                         const CoupleErrors& errors, std::uint64_t seed)
    : clothes_{dancers[0].clothes, dancers[1].clothes}, errors_(errors), random_(seed) {
  Vector3d middle = Vector3d::Zero();
  for (const CoupleDancer& dancer : dancers)
    for (const Pose& pose : dancer.poses)
      middle += pose.p_WH_m.cast<double>() / static_cast<double>(2 * dancer.poses.size());
  if (!camera.middle_m) camera.middle_m = middle;
  for (std::size_t i = 0; i < 2; ++i)
    scenes_[i] = make_scene(i == 0 ? "first" : "second", dancers[i].skeleton, dancers[i].poses, hz,
                            camera, errors.network, seed + i);
  show(0);
}

Vector3d CoupleScene::point_C(std::size_t frame, std::size_t dancer, std::size_t landmark) const {
  const CaptureScene& scene = scenes_[dancer];
  return scene.R_WC.transpose() * (scene.frames[frame].truth_W_m[landmark] - scene.p_WC_m);
}

CoupleScene::Bars CoupleScene::bars(std::size_t frame, std::size_t dancer) const {
  const auto at = [&](Landmark l) { return point_C(frame, dancer, index_of(l)); };
  const auto middle = [&](Landmark l, Landmark r) { return Vector3d(0.5 * (at(l) + at(r))); };
  using enum Landmark;
  return {{{middle(kLeftShoulder, kRightShoulder), middle(kLeftHip, kRightHip), 0.16, 0},
           {at(kLeftShoulder), at(kLeftHip), 0.08, 0},
           {at(kRightShoulder), at(kRightHip), 0.08, 0},
           {at(kLeftHip), at(kLeftKnee), 0.08, 1},
           {at(kRightHip), at(kRightKnee), 0.08, 1},
           {at(kLeftKnee), at(kLeftAnkle), 0.05, 2},
           {at(kRightKnee), at(kRightAnkle), 0.05, 2},
           {at(kLeftShoulder), at(kLeftElbow), 0.045, 3},
           {at(kRightShoulder), at(kRightElbow), 0.045, 3},
           {at(kLeftElbow), at(kLeftWrist), 0.04, 3},
           {at(kRightElbow), at(kRightWrist), 0.04, 3}}};
}

std::array<bool, kLandmarkCount> CoupleScene::hidden_points(std::size_t frame,
                                                            std::size_t dancer) const {
  const Bars partner = bars(frame, 1 - dancer);
  std::array<bool, kLandmarkCount> is_hidden{};
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const Vector3d p = point_C(frame, dancer, i);
    for (const Bar& bar : partner) {
      const NearestPass pass = nearest_pass(p, bar.a_C, bar.b_C);
      const bool is_near = pass.distance_m < bar.radius_m;
      is_hidden[i] = is_hidden[i] || (is_near && pass.share < 1.0 - 0.05 / p.norm());
    }
  }
  return is_hidden;
}

double CoupleScene::hidden(std::size_t frame, std::size_t dancer) const {
  const auto points = hidden_points(frame, dancer);
  double hidden = 0.0;
  for (const LimbJoint& joint : kLimbJoints) hidden += points[index_of(joint.landmark)] ? 1.0 : 0.0;
  return hidden / static_cast<double>(kLimbJoints.size());
}

std::size_t CoupleScene::nearer(std::size_t frame, const SeenBody& body) const {
  std::array<float, 2> distance{};
  for (std::size_t i = 0; i < 2; ++i)
    for (const Landmark l : kTrunk) {
      const Eigen::Vector2d p = scenes_[i].camera.pinhole.project(point_C(frame, i, index_of(l)));
      distance[i] += (p.cast<float>() - body.image_px[index_of(l)].head<2>()).norm();
    }
  return distance[0] <= distance[1] ? 0 : 1;
}

bool CoupleScene::is_in_hold(std::size_t frame) const {
  for (const Landmark a : {Landmark::kLeftWrist, Landmark::kRightWrist})
    for (const Landmark b : {Landmark::kLeftWrist, Landmark::kRightWrist})
      if ((point_C(frame, 0, index_of(a)) - point_C(frame, 1, index_of(b))).norm() < kHold_m)
        return true;
  return false;
}

BodyRegion CoupleScene::region(std::size_t frame, std::size_t dancer) const {
  const Pinhole& pinhole = scenes_[dancer].camera.pinhole;
  const Vector3d hips = 0.5 * (point_C(frame, dancer, index_of(Landmark::kLeftHip)) +
                               point_C(frame, dancer, index_of(Landmark::kRightHip)));
  const Vector2f middle = pinhole.project(hips).cast<float>();
  // Round the hips, as large as the body is high.
  const float radius =
      static_cast<float>(0.6 * scenes_[dancer].height_m * pinhole.fx_px / hips.z());
  return region_of(middle, middle - Vector2f(0.0f, radius));
}

bool CoupleScene::is_in_picture(const BodyRegion& body) const {
  const Pinhole& pinhole = scenes_[0].camera.pinhole;
  return body.centre_x_px > 0.0f && body.centre_x_px < static_cast<float>(pinhole.width_px) &&
         body.centre_y_px > 0.0f && body.centre_y_px < static_cast<float>(pinhole.height_px);
}

bool CoupleScene::is_in_front(std::size_t frame, std::size_t dancer) const {
  const auto depth = [&](std::size_t i) {
    return point_C(frame, i, index_of(Landmark::kLeftHip)).z() +
           point_C(frame, i, index_of(Landmark::kRightHip)).z();
  };
  return depth(dancer) < depth(1 - dancer);
}

void CoupleScene::show(std::size_t frame) {
  frame_ = frame;
  for (std::size_t i = 0; i < 2; ++i) {
    bars_[i] = bars(frame, i);
    is_hidden_[i] = hidden_points(frame, i);
  }
  for (auto& dancer : taken_s_)
    for (double& left : dancer) {
      left -= 1.0 / scenes_[0].hz;
      if (left <= 0.0 && random_.uniform() < errors_.takes_arms_per_s / scenes_[0].hz)
        left = -errors_.takes_arm_for_s * std::log(1.0 - random_.uniform());
    }
}

std::span<const SeenPerson> CoupleScene::find(std::span<const SeenBody* const> without) {
  std::array<bool, 2> is_out{};
  for (const SeenBody* body : without) is_out[nearer(frame_, *body)] = true;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    BodyRegion seen = region(frame_, i);
    if (is_out[i] || hidden(frame_, i) > 1.0 - kFound || !is_in_picture(seen)) continue;
    seen.centre_x_px += static_cast<float>(0.01 * random_.normal()) * seen.side_px;
    seen.centre_y_px += static_cast<float>(0.01 * random_.normal()) * seen.side_px;
    people_[count++] = {0.9f, seen};
  }
  return {people_.data(), count};
}

void CoupleScene::take_arms(std::size_t dancer, SeenBody& body) {
  const BodyLandmarks& partner = scenes_[1 - dancer].frames[frame_].landmarks;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t wrist = index_of(Landmark::kLeftWrist) + side;
    if (!(taken_s_[dancer][side] > 0.0) || !is_hidden_[dancer][wrist]) continue;
    for (const Landmark l : {Landmark::kLeftElbow, Landmark::kLeftWrist, Landmark::kLeftPinky,
                             Landmark::kLeftIndex, Landmark::kLeftThumb}) {
      const std::size_t own = index_of(l) + side, theirs = index_of(l) + (1 - side);
      body.image_px[own] = partner.image_px[theirs];
      body.visibility[own] = 0.9f;
    }
  }
}

bool CoupleScene::read(const BodyRegion& wished, const OtherPeople& others, ReadBody& out) {
  std::array<bool, 2> is_out{};
  for (const SeenBody* other : others.before) is_out[nearer(frame_, *other)] = true;
  std::array<float, 2> off{};
  for (std::size_t i = 0; i < 2; ++i) {
    const BodyRegion is = region(frame_, i);
    off[i] = (centre_of(is) - centre_of(wished)).norm() / wished.side_px +
             std::abs(std::log(is.side_px / wished.side_px));
  }
  std::size_t seen = is_out[0] ? 1 : is_out[1] ? 0 : off[0] <= off[1] ? 0 : 1;
  if (is_out[0] && is_out[1]) return false;
  if (hidden(frame_, seen) > kTakenForPartner && is_in_front(frame_, 1 - seen) && !is_out[1 - seen])
    seen = 1 - seen;
  const double hidden_share = hidden(frame_, seen);
  out.body.presence = off[seen] > 0.6f || !is_in_picture(region(frame_, seen))
                          ? 0.1f
                          : static_cast<float>(1.0 - 0.8 * hidden_share);
  const BodyLandmarks& landmarks = scenes_[seen].frames[frame_].landmarks;
  out.body.image_px = landmarks.image_px;
  out.body.world_m = landmarks.world_m;
  out.body.visibility = landmarks.visibility;
  const BodyRegion is = region(frame_, seen);
  const double guess_px =
      errors_.network.hidden_image_sd * errors_.network.image_sd * static_cast<double>(is.side_px);
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    out.is_covered[i] = is_hidden_[seen][i] && is_out[1 - seen];
    if (!is_hidden_[seen][i]) continue;
    out.body.image_px[i].x() += static_cast<float>(guess_px * random_.normal());
    out.body.image_px[i].y() += static_cast<float>(guess_px * random_.normal());
    out.body.visibility[i] = std::min(out.body.visibility[i], 0.5f);
  }
  take_arms(seen, out.body);
  const Vector2f middle = centre_of(is);
  out.body.next_px = {middle, middle - Vector2f(0.0f, 0.5f * is.side_px / 1.25f)};
  return true;
}

std::optional<PictureColour> CoupleScene::colour(const Vector2f& place_px) {
  const Pinhole& pinhole = scenes_[0].camera.pinhole;
  if (!(place_px.x() >= 0.0f) || !(place_px.y() >= 0.0f) ||
      place_px.x() >= static_cast<float>(pinhole.width_px) ||
      place_px.y() >= static_cast<float>(pinhole.height_px))
    return std::nullopt;
  const Vector3d far = 20.0 * Vector3d((place_px.x() - pinhole.cx_px) / pinhole.fx_px,
                                       (place_px.y() - pinhole.cy_px) / pinhole.fy_px, 1.0);
  PictureColour colour = kBackground;
  double nearest = 1.0;
  for (std::size_t i = 0; i < 2; ++i)
    for (const Bar& bar : bars_[i]) {
      const NearestPass pass = nearest_pass(far, bar.a_C, bar.b_C);
      if (pass.distance_m >= bar.radius_m || pass.share >= nearest) continue;
      nearest = pass.share;
      colour = clothes_[i][bar.part];
    }
  for (int c = 0; c < 3; ++c) colour[c] += static_cast<float>(errors_.colour_sd * random_.normal());
  return colour;
}

}  // namespace dance
