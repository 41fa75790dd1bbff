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

std::optional<float> delay_of(const SceneGuest& guest) {
  return guest.figures.beat ? guest.figures.beat->delay_ms : std::nullopt;
}

// What is newer by so much than what has come is a guess.
constexpr float kNewer_ms = 5.0f;

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
  // Both halves have the same guests, in one order.
  std::optional<std::size_t> latest;
  for (const SceneGuest& guest : comparison.shown.guests) {
    const auto twin_id = raw_twin_of(guest.id);
    const SceneGuest* twin = twin_id ? find_guest(scene, *twin_id) : nullptr;
    comparison.raw.guests.push_back(twin != nullptr ? *twin : guest);
    comparison.raw.guests.back().id = guest.id;
    if (twin == nullptr || !delay_of(*twin)) continue;
    if (!latest || *delay_of(*twin) > *delay_of(comparison.raw.guests[*latest]))
      latest = comparison.raw.guests.size() - 1;
  }
  if (!latest) return comparison;
  SceneGuest& raw = comparison.raw.guests[*latest];
  SceneGuest& shown = comparison.shown.guests[*latest];
  raw.is_compared = shown.is_compared = true;
  shown.is_guess = delay_of(shown) && *delay_of(shown) < *delay_of(raw) - kNewer_ms;
  return comparison;
}

void leave_out_twins(SceneState& scene) {
  std::vector<SceneGuest> kept;
  for (const SceneGuest& guest : scene.guests)
    if (!is_twin(scene, guest.id)) kept.push_back(guest);
  scene.guests = std::move(kept);
}

}  // namespace dance
