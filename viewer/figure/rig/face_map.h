// FaceMap: binds a dancer's face to an avatar's morph targets: those with ARKit's names, or
// expressions of these names; for abilities without them VRM's vowels, lids, smile and look.
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
  // True if morphs move the eyes.
  bool has_look() const { return has_look_; }
  // Adds the face to the weights of the model's morphs.
  void add(const Face& face, std::span<float> morph_weights) const;

 private:
  struct Bind {
    std::uint8_t source = 0;  // an Expression, or behind these one of VRM's
    std::uint32_t morph = 0;
    float weight = 1.0f;
  };
  // Returns how many of ARKit's names the model has, and which abilities they cover.
  int add_arkit(const AvatarModel& model, std::span<bool> has_ability);

  std::vector<Bind> binds_;
  bool has_look_ = false;
};

}  // namespace dance
