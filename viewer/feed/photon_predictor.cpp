#include "viewer/feed/photon_predictor.h"

#include <algorithm>

namespace dance {

void PhotonPredictor::observe(std::span<const StageRoster::Fresh> fresh) {
  for (const StageRoster::Fresh& it : fresh) {
    Guest* place = &guests_.front();  // of this guest, or of the one heard longest ago
    for (Guest& guest : guests_) {
      if (guest.id == it.guest) {
        place = &guest;
        break;
      }
      if (guest.moment < place->moment) place = &guest;
    }
    if (place->id != it.guest) {
      place->id = it.guest;
      place->motion.clear();
    }
    if (!it.moment.is_set()) {
      place->motion.clear();
      place->moment = MonoTime();
      continue;
    }
    place->moment = it.moment;
    place->motion.observe(it.pose, it.moment);
  }
}

void PhotonPredictor::predict(MonoTime photon, SceneState& scene) const {
  for (SceneGuest& guest : scene.guests) {
    const auto at = std::find_if(guests_.begin(), guests_.end(), [&](const Guest& known) {
      return known.id == guest.id && known.moment.is_set();
    });
    if (at != guests_.end()) guest.pose = at->motion.at(photon, guest.skeleton);
  }
}

}  // namespace dance
