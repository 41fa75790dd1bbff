// Figures for the guests of a scene made by hand: mannequins, as a display gives them.
//
// Units/frames: as viewer/scene/scene.h.
// Ownership:    keeps the models until the program ends, as each takes a moment to make.
// Threads:      one.
// Failure:      none.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "formats/avatar/mannequin_model.h"
#include "viewer/scene/scene.h"

namespace dance {

inline std::shared_ptr<const AvatarModel> mannequin_of(const SceneGuest& guest) {
  static std::map<std::pair<std::string, float>, std::shared_ptr<const AvatarModel>> made;
  auto& model = made[{std::string(guest.id.view()), guest.skeleton.hips_height_m()}];
  if (!model)
    model = std::make_shared<const AvatarModel>(
        mannequin_model(guest.skeleton, look_of(guest.id), guest.hands.has_value()));
  return model;
}

// Guests without an avatar get their mannequin; of a crowd each gets that of one of the first four.
inline SceneState dressed(SceneState scene) {
  for (std::size_t i = 0; i < scene.guests.size(); ++i)
    if (scene.guests[i].avatar == nullptr)
      scene.guests[i].avatar = mannequin_of(scene.guests[i % 4]);
  return scene;
}

}  // namespace dance
