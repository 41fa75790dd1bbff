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

class PeopleVision {
 public:
  virtual ~PeopleVision() = default;
  // A pass over the whole picture: the surest first.
  virtual std::span<const SeenPerson> find() = 0;
  // The body in the region, with `presence` as the network has it; `others` are before it, and are
  // not looked at.
  virtual bool read(const BodyRegion& region, std::span<const SeenBody* const> others,
                    ReadBody& out) = 0;
  virtual std::optional<PictureColour> colour(const Eigen::Vector2f& place_px) = 0;
};

}  // namespace dance
