// How a crowd dances: each guest a dance of her own. Recorded takes are danced over and over, each
// guest from another moment of them on; without takes it is the synthetic salsa, leads and
// follows of many couples, each with its own seed, tempo and phase. Each stands where her placement
// says, all of a room in a square.
//
// Units/frames: metres in W; t as in producers/dancer.h.
// Ownership:    takes are shared; a dancer is the caller's.
// Threads:      dancers of one CrowdDances may dance in several threads; load() reads files.
// Failure:      load() names the file and what is wrong with it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/clip.h"
#include "producers/dancer.h"

namespace dance {

class CrowdDances {
 public:
  static Result<CrowdDances> load(const std::vector<std::string>& takes);

  struct Place {
    double x_m = 0.0, z_m = 0.0, heading_deg = 0.0;
  };
  // Two metres apart, in rows of the square that holds so many.
  static Place place_of(std::size_t place, std::size_t guests);
  std::unique_ptr<Dancer> make(std::size_t guest) const;
  // Where in her dance a guest begins, so that no two are in step.
  static Duration phase_of(std::size_t guest);

 private:
  std::vector<std::shared_ptr<const MotionClip>> clips_;
};

}  // namespace dance
