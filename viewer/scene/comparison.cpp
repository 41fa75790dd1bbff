#include "viewer/scene/comparison.h"

#include <algorithm>
#include <utility>

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
  Comparison comparison;
  compare(scene, comparison);
  return comparison;
}

void compare(const SceneState& scene, Comparison& comparison) {
  comparison.is_of_twins = has_twins(scene);
  comparison.shown = scene;
  if (comparison.is_of_twins) leave_out_twins(comparison.shown);
  comparison.raw = comparison.shown;
  comparison.shown.notes.clear();  // once is enough
  comparison.raw.stage = -1 - scene.stage;
  // Both halves have the same guests, in one order.
  std::optional<std::size_t> latest;
  for (std::size_t i = 0; i < comparison.shown.guests.size(); ++i) {
    SceneGuest& shown = comparison.shown.guests[i];
    SceneGuest& raw = comparison.raw.guests[i];
    const auto twin_id = comparison.is_of_twins ? raw_twin_of(shown.id) : std::nullopt;
    const SceneGuest* twin = twin_id ? find_guest(scene, *twin_id) : nullptr;
    if (twin != nullptr) {
      raw = *twin;
      raw.id = shown.id;
      raw.avatar = shown.avatar;
    } else if (is_pair(twin, shown)) {
      raw.pose = *shown.arriving;
      raw.figures.beat = shown.arriving_beat;
      shown.pose = *shown.staged;
    }
    if (!is_pair(twin, shown) || !delay_of(raw)) continue;
    shown.is_predicted = delay_of(shown) && is_predicted(*delay_of(shown), *delay_of(raw));
    if (!latest || *delay_of(raw) > *delay_of(comparison.raw.guests[*latest])) latest = i;
  }
  if (latest)
    for (SceneState* half : {&comparison.raw, &comparison.shown})
      half->guests[*latest].is_compared = true;
}

void leave_out_twins(SceneState& scene) {
  if (!has_twins(scene)) return;
  // By swaps, as each question looks for the dancer among all that were there.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scene.guests.size(); ++i)
    if (!is_twin(scene, scene.guests[i].id)) std::swap(scene.guests[kept++], scene.guests[i]);
  scene.guests.erase(scene.guests.begin() + static_cast<std::ptrdiff_t>(kept), scene.guests.end());
}

}  // namespace dance
