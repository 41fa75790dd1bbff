// Cloth of an avatar that swings: a skirt on chains of nodes round the hips, or a sash with two
// hanging ends; and the band round the waist that covers where the clothes meet.
//
// Units/frames: as Sheet.
// Ownership:    plain values; `clothes` are layers of the figure, and must outlive the maker.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <span>

#include "formats/avatar/make/bent_figure.h"
#include "formats/avatar/make/model_builder.h"
#include "formats/body/figure_builder.h"

namespace dance {

class SkirtMaker {
 public:
  SkirtMaker(const Skeleton& skeleton, std::span<const FigureLayer> clothes);

  Sheet band() const;
  Sheet skirt(ModelBuilder& builder, const std::vector<std::uint32_t>& colliders) const;
  Sheet sash_ends(ModelBuilder& builder, const std::vector<std::uint32_t>& colliders) const;
  // A shirt's collar, standing round the neck.
  Sheet collar() const;

 private:
  struct SashEnd {
    float turn;
    float length_m;
    float lift_m;  // off the clothes
  };
  Eigen::Vector3f skirt_place_m(float turn, float down, float fold) const;
  Eigen::Vector3f sash_middle_m(const SashEnd& end, float down) const;
  Sheet sash_end(const SashEnd& end, const std::vector<int>& chain) const;
  // How far from the spine's axis all clothes are inside, `turn` from the front to the left.
  float radius_m(float turn, float y_m) const;
  Eigen::Vector3f around(float turn, float y_m, float lift_m) const;
  float waist_y_m(float turn) const;

  SkinWeighting weighting_;
  TposePlaces places_;
  std::span<const FigureLayer> clothes_;
};

}  // namespace dance
