#include "viewer/view/couple_finder.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace dance {
namespace {

float apart_m(const SceneGuest& a, const SceneGuest& b) {
  Eigen::Vector3f d = a.pose.p_WH_m - b.pose.p_WH_m;
  d.y() = 0.0f;
  return d.norm();
}

std::optional<std::size_t> find(const SceneState& scene, const GuestId& id) {
  for (std::size_t i = 0; i < scene.guests.size(); ++i)
    if (scene.guests[i].id == id) return i;
  return std::nullopt;
}

}  // namespace

const std::vector<std::vector<std::size_t>>& ViewCoupleFinder::groups(const SceneState& scene) {
  const std::size_t n = scene.guests.size();
  constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> partner(n, kNobody);
  std::erase_if(couples_, [&](Couple& couple) {
    const auto a = find(scene, couple.first);
    const auto b = find(scene, couple.second);
    if (!a || !b) return true;
    if (apart_m(scene.guests[*a], scene.guests[*b]) < kParted_m) couple.last_together = scene.time;
    if (scene.time - couple.last_together > kPartingTakes) return true;
    partner[*a] = *b;
    partner[*b] = *a;
    return false;
  });
  const auto nearest_free = [&](std::size_t i) {
    std::size_t nearest = kNobody;
    for (std::size_t k = 0; k < n; ++k)
      if (k != i && partner[k] == kNobody &&
          (nearest == kNobody || apart_m(scene.guests[i], scene.guests[k]) <
                                     apart_m(scene.guests[i], scene.guests[nearest])))
        nearest = k;
    return nearest;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (partner[i] != kNobody) continue;
    const std::size_t k = nearest_free(i);
    if (k == kNobody || apart_m(scene.guests[i], scene.guests[k]) > kTogether_m ||
        nearest_free(k) != i)
      continue;
    partner[i] = k;
    partner[k] = i;
    couples_.push_back({scene.guests[i].id, scene.guests[k].id, scene.time});
  }
  groups_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (partner[i] == kNobody)
      groups_.push_back({i});
    else if (partner[i] > i)
      groups_.push_back({i, partner[i]});
  }
  return groups_;
}

}  // namespace dance
