// PeopleVision: what the tracking of several people asks of one picture: who is in it, the body in
// a region, and the colour at a place. Implemented by the networks (network_vision.h) and, for
// tests and evaluations, by drawn scenes of known truth.
//
// Units/frames: pixels as producers/camera/region/picture_region.h has them; colours are luma,
//               blue and red difference, each 0…1.
// Ownership:    what find() returns is good until the next call of find().
// Threads:      one owner.
// Failure:      nobody is found, read() is false, and there is no colour outside of the picture.
#pragma once

#include <bitset>
#include <optional>
#include <span>

#include "producers/camera/estimator/landmark_network.h"
#include "producers/camera/estimator/person_detector.h"

namespace dance {

using PictureColour = Eigen::Vector3f;

struct ReadBody {
  SeenBody body;
  std::bitset<kLandmarkCount> is_covered;  // points behind one of the others: guessed
};

// Who else is in a region; all of them overlap it.
struct OtherPeople {
  // Nearer to the camera than the wished body: not looked at, and what they cover is guessed.
  std::span<const SeenBody* const> before;
  // Where they are expected, not read yet: not looked at, but for where the wished body is
  // expected.
  std::span<const SeenBody* const> behind;
  const SeenBody* own = nullptr;  // where the wished body is expected; null: not known
};

class PeopleVision {
 public:
  virtual ~PeopleVision() = default;
  // A pass over the whole picture: the surest first. `without` are not looked at, so that who is
  // beside or half behind them is found.
  virtual std::span<const SeenPerson> find(std::span<const SeenBody* const> without) = 0;
  // The body in the region, with `presence` as the network has it.
  virtual bool read(const BodyRegion& region, const OtherPeople& others, ReadBody& out) = 0;
  virtual std::optional<PictureColour> colour(const Eigen::Vector2f& place_px) = 0;
};

}  // namespace dance
