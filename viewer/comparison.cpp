#include "viewer/comparison.h"

#include <algorithm>

#include "core/base/raw_twin.h"

namespace dance {
namespace {

const SceneGuest* find_guest(const SceneState& scene, const GuestId& id) {
  const auto found = std::find_if(scene.guests.begin(), scene.guests.end(),
                                  [&](const SceneGuest& guest) { return guest.id == id; });
  return found == scene.guests.end() ? nullptr : &*found;
}

// Whoever is merely called so is a guest like others.
bool is_twin(const SceneState& scene, const GuestId& id) {
  const auto whose = twin_of_whom(id);
  return whose && find_guest(scene, *whose) != nullptr;
}

}  // namespace

bool has_twins(const SceneState& scene) {
  return std::any_of(scene.guests.begin(), scene.guests.end(),
                     [&](const SceneGuest& guest) { return is_twin(scene, guest.id); });
}

Comparison compare(const SceneState& scene) {
  Comparison comparison{scene, scene};
  leave_out_twins(comparison.shown);
  comparison.shown.notes.clear();  // once is enough
  comparison.raw.guests.clear();
  for (const SceneGuest& guest : scene.guests) {
    if (is_twin(scene, guest.id)) continue;
    const auto twin_id = raw_twin_of(guest.id);
    const SceneGuest* twin = twin_id ? find_guest(scene, *twin_id) : nullptr;
    SceneGuest& raw = comparison.raw.guests.emplace_back(twin != nullptr ? *twin : guest);
    raw.id = guest.id;
    raw.is_compared = twin != nullptr;
  }
  // Both halves have the same guests now, in one order.
  for (std::size_t i = 0; i < comparison.raw.guests.size(); ++i)
    comparison.shown.guests[i].is_compared = comparison.raw.guests[i].is_compared;
  return comparison;
}

void leave_out_twins(SceneState& scene) {
  std::vector<SceneGuest> kept;
  for (const SceneGuest& guest : scene.guests)
    if (!is_twin(scene, guest.id)) kept.push_back(guest);
  scene.guests = std::move(kept);
}

}  // namespace dance
