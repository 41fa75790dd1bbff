#include "producers/camera/people/person_track.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// In sides of the region, which are about one and a half times a body's height: how far the middle
// of the hips may be from where it is expected, at once and for each second since the last picture.
constexpr float kJump_sides = 0.12f, kJump_sides_per_s = 1.5f;
constexpr float kGrowth = 1.4f;
constexpr float kSpeedWeight = 0.3f;
constexpr float kSpeedFades_s = 0.5f;
// After so long a body may be in any posture.
constexpr Duration kKeepsPosture = Duration::ms(250);

// In lengths of the body's measure, mean of joints.
constexpr float kSameBody = 0.06f;

// The mean of the joints; with `other_sides` of a left one from a right one.
float distance_px(const SeenBody& a, const SeenBody& b, bool other_sides) {
  float sum = 0.0f;
  for (std::size_t j = 0; j < kBodyJoints.size(); ++j)
    sum += (a.place_px(kBodyJoints[j]) - b.place_px(kBodyJoints[j ^ (other_sides ? 1 : 0)])).norm();
  return sum / static_cast<float>(kBodyJoints.size());
}

}  // namespace

bool are_one_body(const SeenBody& a, const SeenBody& b) {
  return distance_px(a, b, false) < kSameBody * std::max(1.0f, std::min(a.size_px(), b.size_px()));
}

Eigen::Vector2f PersonTrack::expected_px(MonoTime now) const {
  const float passed_s = static_cast<float>((now - seen_).as_seconds());
  return centre_of(region_) +
         kSpeedFades_s * (1.0f - std::exp(-passed_s / kSpeedFades_s)) * speed_px_s_;
}

bool PersonTrack::is_plausible(const BodyRegion& region, MonoTime now) const {
  if (!was_ever_seen()) return true;
  const float passed_s = static_cast<float>((now - seen_).as_seconds());
  const float allowed = (kJump_sides + kJump_sides_per_s * passed_s) * region_.side_px;
  const float growth = region.side_px / region_.side_px;
  const float most_growth = kGrowth * (1.0f + passed_s);
  return (centre_of(region) - expected_px(now)).norm() <= allowed && growth <= most_growth &&
         growth * most_growth >= 1.0f;
}

std::optional<SeenBody> PersonTrack::expected_body(MonoTime now) const {
  if (!was_ever_seen() || now - seen_ > kKeepsPosture) return std::nullopt;
  SeenBody body = body_;
  const Eigen::Vector2f moved = expected_px(now) - centre_of(region_);
  for (Eigen::Vector3f& p : body.image_px) p.head<2>() += moved;
  for (Eigen::Vector2f& p : body.next_px) p += moved;
  return body;
}

std::optional<float> PersonTrack::off_course(const SeenBody& body, MonoTime now) const {
  const auto expected = expected_body(now);
  if (!expected) return std::nullopt;
  return std::min(distance_px(body, *expected, false), distance_px(body, *expected, true)) /
         std::max(1.0f, body.size_px());
}

void PersonTrack::update(const SeenBody& body, MonoTime now) {
  const BodyRegion is = body.next_region();
  if (is_begun_ && now > seen_) {
    const auto passed_s = static_cast<float>((now - seen_).as_seconds());
    const Eigen::Vector2f speed = (centre_of(is) - centre_of(region_)) / passed_s;
    speed_px_s_ += kSpeedWeight * (speed - speed_px_s_);
  } else {
    speed_px_s_.setZero();
  }
  region_ = is;
  body_ = body;
  seen_ = now;
  is_begun_ = true;
  SeenBody steadied = body;
  smoothing_.smooth(now, true, steadied);
  next_ = steadied.next_region();
  if (!(next_->side_px >= 1.0f)) lose();
}

void PersonTrack::lose() {
  next_.reset();
  is_begun_ = false;
  smoothing_.lose();
}

}  // namespace dance
