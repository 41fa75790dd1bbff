// PersonLook: the colours of a person's clothes in one picture; LookModel: those of a person,
// learned over time, and how far a picture's are from them. By these, two dancers are told apart
// after one has hidden the other.
//
// Units/frames: as producers/camera/people/people_vision.h says.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      a part that is not seen has no weight; without a common part there is no distance.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "producers/camera/people/people_vision.h"

namespace dance {

// Trunk, thighs, shanks, upper arms.
constexpr std::size_t kLookParts = 4;

struct PersonLook {
  std::array<PictureColour, kLookParts> colour;  // the median of places on the part
  std::array<bool, kLookParts> is_seen{};
};

// Where the points of the body are visible.
PersonLook look_of(const SeenBody& body, PeopleVision& vision);

class LookModel {
 public:
  void learn(const PersonLook& look);
  // The mean over common parts of squared differences over their variance, each 9 at most.
  std::optional<float> distance(const PersonLook& look) const;
  // Of one place in a picture from the nearest part.
  float distance(const PictureColour& colour) const;
  // Whether the two can be told apart by their clothes.
  bool differs_from(const LookModel& other) const;
  // Whether enough pictures were learned to judge by.
  bool is_known() const { return pictures_ >= kKnown; }
  void reset() { *this = {}; }

 private:
  static constexpr int kKnown = 10;
  struct Part {
    PictureColour mean = PictureColour::Zero();
    PictureColour variance = PictureColour::Zero();
    int pictures = 0;
    float squared(const PictureColour& colour) const;  // over the variance, bounded
  };
  std::array<Part, kLookParts> parts_;
  int pictures_ = 0;
};

}  // namespace dance
