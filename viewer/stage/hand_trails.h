// HandTrails: where the hands of every guest were in the last second, and the smooth ribbons that
// show it.
//
// Units/frames: metres in W; times of the house's clock.
// Ownership:    plain values; remembers guests for as long as their trail is seen.
// Threads:      none inside.
// Failure:      none: a moment before the last one, or long after it, begins anew.
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "viewer/figure/figure_poser.h"

namespace dance {

// As the vertex shader takes it; six make two triangles.
struct RibbonVertex {
  Eigen::Vector3f place_W_m;
  float across;  // -1..1 from edge to edge
  Eigen::Vector3f colour;
  float strength;
};
static_assert(sizeof(RibbonVertex) == 32);

class HandTrails {
 public:
  static constexpr Duration kSeen = Duration::ms(900);

  // The figures of a moment. The same moment again changes it.
  void add(MonoTime time, std::span<const PosedFigure> figures);
  // Ribbons that face the eye, fading towards their ends.
  void append_ribbons(const Eigen::Vector3f& eye_W_m, std::vector<RibbonVertex>& triangles) const;
  void clear() { trails_.clear(); }

 private:
  struct Sample {
    MonoTime time;
    std::array<Eigen::Vector3f, 2> hands_W_m;
  };
  struct Trail {
    std::deque<Sample> samples;
    float opacity = 1.0f;
  };
  void append_ribbon(const GuestId& id, const Trail& trail, std::size_t hand,
                     const Eigen::Vector3f& eye_W_m, std::vector<RibbonVertex>& triangles) const;

  MonoTime newest_;
  std::map<GuestId, Trail> trails_;
};

}  // namespace dance
