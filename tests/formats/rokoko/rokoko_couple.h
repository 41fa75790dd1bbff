// A couple as actors of Rokoko Studio, for tests.
//
// Ownership: returns values.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include <memory>

#include "formats/rokoko/rokoko_actor.h"
#include "producers/salsa/salsa_dancer.h"

namespace dance {

inline SalsaDancer salsa_dancer(SalsaRole role) {
  SalsaStyle style;
  style.role = role;
  return SalsaDancer(style);
}

inline std::unique_ptr<RokokoFrame> rokoko_couple(double seconds) {
  auto frame = std::make_unique<RokokoFrame>();
  frame->timestamp_s = seconds;
  for (const SalsaRole role : {SalsaRole::kLead, SalsaRole::kFollow}) {
    SalsaDancer dancer = salsa_dancer(role);
    Pose pose;
    Hands hands;
    dancer.dance_at(Duration::seconds(seconds), pose);
    const bool has_hands = dancer.hands_at(Duration::seconds(seconds), hands);
    RokokoActor actor;
    (void)actor.name.assign(role == SalsaRole::kLead ? "ana" : "ben");
    make_rokoko_actor(dancer.skeleton(), pose, has_hands ? &hands : nullptr, actor);
    (void)frame->actors.try_push(actor);
  }
  return frame;
}

}  // namespace dance
