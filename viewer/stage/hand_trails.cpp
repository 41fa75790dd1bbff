#include "viewer/stage/hand_trails.h"

#include <algorithm>
#include <cmath>

#include "formats/body/guest_look.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr Duration kGap = Duration::ms(300);
constexpr float kJump_m = 0.8f;  // between two pictures: a hand was put elsewhere
constexpr float kHalfWidth_m = 0.022f;
constexpr float kStrength = 0.75f;
constexpr std::size_t kPiecesOfStep_s = 120;  // a second of trail is so many straight pieces
constexpr std::size_t kMostPieces = 8;

// Through b and c, with a before and d after them.
Vector3f catmull_rom(const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& d,
                     float t) {
  return 0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                 (3.0f * b - a - 3.0f * c + d) * t * t * t);
}

// The middle of the hand and not its wrist.
std::array<Vector3f, 2> hands_of(const BodyFrames& frames) {
  return {0.5f * (frames.position(Bone::kLeftHand) + frames.tip(Tip::kLeftHand)),
          0.5f * (frames.position(Bone::kRightHand) + frames.tip(Tip::kRightHand))};
}

bool has_jumped(const std::array<Vector3f, 2>& from, const std::array<Vector3f, 2>& to) {
  return (from[0] - to[0]).norm() > kJump_m || (from[1] - to[1]).norm() > kJump_m;
}

}  // namespace

void HandTrails::add(MonoTime time, std::span<const PosedFigure> figures) {
  if (newest_.is_set() && (time < newest_ || time - newest_ > kGap)) clear();
  newest_ = time;
  for (const PosedFigure& figure : figures) {
    Trail& trail = trails_[figure.id];
    auto& samples = trail.samples;
    const auto hands = hands_of(figure.frames);
    if (!samples.empty() && samples.back().time == time) samples.pop_back();
    if (!samples.empty() &&
        (time - samples.back().time > kGap || has_jumped(samples.back().hands_W_m, hands)))
      samples.clear();
    samples.push_back({time, hands});
    trail.opacity = figure.opacity;
  }
  for (auto it = trails_.begin(); it != trails_.end();) {
    auto& samples = it->second.samples;
    while (!samples.empty() && time - samples.front().time > kSeen) samples.pop_front();
    it = samples.empty() ? trails_.erase(it) : std::next(it);
  }
}

void HandTrails::append_ribbons(const Vector3f& eye_W_m,
                                std::vector<RibbonVertex>& triangles) const {
  for (const auto& [id, trail] : trails_)
    for (const std::size_t hand : {0u, 1u}) append_ribbon(id, trail, hand, eye_W_m, triangles);
}

void HandTrails::append_ribbon(const GuestId& id, const Trail& trail, std::size_t hand,
                               const Vector3f& eye_W_m,
                               std::vector<RibbonVertex>& triangles) const {
  const auto& samples = trail.samples;
  if (samples.size() < 2) return;
  const Vector3f colour = look_of(id).tag;
  const auto last = static_cast<std::ptrdiff_t>(samples.size()) - 1;
  const auto at = [&](std::ptrdiff_t i) -> const Vector3f& {
    return samples[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))]
        .hands_W_m[hand];
  };
  std::array<RibbonVertex, 2> edge{};
  bool has_edge = false;
  const auto put = [&](const Vector3f& place, const Vector3f& along, double age_s) {
    Vector3f side = along.cross(eye_W_m - place);
    side = side.squaredNorm() > 1e-12f ? Vector3f(side.normalized()) : Vector3f::UnitY();
    const float left = 1.0f - static_cast<float>(std::min(1.0, age_s / kSeen.as_seconds()));
    const float half = kHalfWidth_m * (0.25f + 0.75f * left);
    const float strength = kStrength * trail.opacity * left * left;
    const std::array<RibbonVertex, 2> next{
        RibbonVertex{place - half * side, -1.0f, colour, strength},
        RibbonVertex{place + half * side, 1.0f, colour, strength}};
    if (has_edge)
      for (const RibbonVertex& vertex : {edge[0], edge[1], next[1], edge[0], next[1], next[0]})
        triangles.push_back(vertex);
    edge = next;
    has_edge = true;
  };
  for (std::ptrdiff_t i = 0; i < last; ++i) {
    const Sample& from = samples[static_cast<std::size_t>(i)];
    const double step_s = (samples[static_cast<std::size_t>(i + 1)].time - from.time).as_seconds();
    const auto pieces = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::lround(step_s * double{kPiecesOfStep_s})), 1, kMostPieces);
    const double age_s = (newest_ - from.time).as_seconds();
    for (std::size_t k = i == 0 ? 0 : 1; k <= pieces; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(pieces);
      const auto curve = [&](float u) {
        return catmull_rom(at(i - 1), at(i), at(i + 1), at(i + 2), u);
      };
      put(curve(t), curve(t + 0.05f) - curve(t - 0.05f), age_s - static_cast<double>(t) * step_s);
    }
  }
}

}  // namespace dance
