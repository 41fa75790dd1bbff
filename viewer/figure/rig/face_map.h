// FaceMap: which of an avatar's morph targets a dancer's face moves: those with ARKit's names, or
// expressions of these names; where a figure has too few of them, VRM's vowels and lids.
//
// Units/frames: weights 0…1.
// Ownership:    owns its lists; refers to nothing.
// Threads:      none inside.
// Failure:      none: a figure without a face has an empty map, and weights stay 0…1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/pose/face.h"
#include "formats/avatar/avatar_model.h"

namespace dance {

class FaceMap {
 public:
  FaceMap() = default;
  explicit FaceMap(const AvatarModel& model);
  bool is_empty() const { return binds_.empty(); }
  // Adds the face to the weights of the model's morphs.
  void add(const Face& face, std::span<float> morph_weights) const;

 private:
  struct Bind {
    std::uint8_t source = 0;  // an Expression, or behind these one of VRM's
    std::uint32_t morph = 0;
    float weight = 1.0f;
  };
  std::vector<Bind> binds_;
};

}  // namespace dance
