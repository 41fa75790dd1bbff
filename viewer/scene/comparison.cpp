#include "viewer/scene/comparison.h"

#include <algorithm>

#include "core/base/raw_twin.h"
#include "viewer/scene/beat_words.h"

namespace dance {
namespace {

const SceneGuest* find_guest(const SceneState& scene, const GuestId& id) {
  const auto found = std::find_if(scene.guests.begin(), scene.guests.end(),
                                  [&](const SceneGuest& guest) { return guest.id == id; });
  return found == scene.guests.end() ? nullptr : &*found;
}

std::optional<double> delay_of(const SceneGuest& guest) {
  return guest.figures.beat ? guest.figures.beat->delay_ms : std::nullopt;
}

// A guest with such a name but without its original is a guest like others.
bool is_twin(const SceneState& scene, const GuestId& id) {
  const auto whose = twin_of_whom(id);
  return whose && find_guest(scene, *whose) != nullptr;
}

// Whether the two halves show different poses of this dancer.
bool is_pair(const SceneGuest* twin, const SceneGuest& guest) {
  return twin != nullptr || (guest.arriving && guest.staged);
}

}  // namespace

bool has_twins(const SceneState& scene) {
  return std::any_of(scene.guests.begin(), scene.guests.end(),
                     [&](const SceneGuest& guest) { return is_twin(scene, guest.id); });
}

bool can_compare(const SceneState& scene) {
  return has_twins(scene) ||
         std::any_of(scene.guests.begin(), scene.guests.end(),
                     [](const SceneGuest& guest) { return guest.arriving && guest.staged; });
}

Comparison compare(const SceneState& scene) {
  Comparison comparison{scene, scene, has_twins(scene)};
  leave_out_twins(comparison.shown);
  comparison.shown.notes.clear();  // once is enough
  comparison.raw.guests.clear();
  comparison.raw.stage = -1 - scene.stage;
  // Both halves have the same guests, in one order.
  std::optional<std::size_t> latest;
  for (SceneGuest& shown : comparison.shown.guests) {
    const auto twin_id = raw_twin_of(shown.id);
    const SceneGuest* twin = twin_id ? find_guest(scene, *twin_id) : nullptr;
    SceneGuest& raw = comparison.raw.guests.emplace_back(twin != nullptr ? *twin : shown);
    raw.id = shown.id;
    raw.avatar = shown.avatar;
    if (twin == nullptr && is_pair(twin, shown)) {
      raw.pose = *shown.arriving;
      raw.figures.beat = shown.arriving_beat;
      shown.pose = *shown.staged;
    }
    if (!is_pair(twin, shown) || !delay_of(raw)) continue;
    shown.is_predicted = delay_of(shown) && is_predicted(*delay_of(shown), *delay_of(raw));
    if (!latest || *delay_of(raw) > *delay_of(comparison.raw.guests[*latest]))
      latest = comparison.raw.guests.size() - 1;
  }
  if (latest)
    for (SceneState* half : {&comparison.raw, &comparison.shown})
      half->guests[*latest].is_compared = true;
  return comparison;
}

void leave_out_twins(SceneState& scene) {
  std::vector<SceneGuest> kept;
  for (const SceneGuest& guest : scene.guests)
    if (!is_twin(scene, guest.id)) kept.push_back(guest);
  scene.guests = std::move(kept);
}

}  // namespace dance
