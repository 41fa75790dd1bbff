// FigureBuilder: the layers of a dancer's figure: skin, clothes, shoes, hair and face round the
// canonical bones, in the dancer's own proportions and in the clothes that the viewer draws it in.
//
// Units/frames: local places are metres of a body 1.72 m tall, from the bone's origin; what comes
//               out is in T-pose, W, scaled to the dancer.
// Ownership:    owns the layers until take().
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <utility>

#include "core/pose/skeleton.h"
#include "formats/body/figure_part.h"
#include "formats/body/guest_look.h"

namespace dance {

// Every bone's place in T-pose, and the five ends of the body.
struct TposePlaces {
  explicit TposePlaces(const Skeleton& skeleton);
  const Eigen::Vector3f& at(Bone bone) const { return bones_m[index_of(bone)]; }
  const Eigen::Vector3f& at(Tip tip) const { return tips_m[static_cast<std::size_t>(tip)]; }

  std::array<Eigen::Vector3f, kBoneCount> bones_m;
  std::array<Eigen::Vector3f, kTipCount> tips_m;
  float scale = 1.0f;    // to a body 1.72 m tall
  float breadth = 1.0f;  // of the shoulders, beside an average body of this height
};

class FigureBuilder {
 public:
  FigureBuilder(const Skeleton& skeleton, const GuestLook& look, bool has_fingers);

  std::vector<FigureLayer> take();
  // The figure without head and hair, for figures that have their own.
  std::vector<FigureLayer> take_below_head();
  // Without head, hair and skirt, for figures that bring their own; below a skirt of their own they
  // wear short trousers.
  std::vector<FigureLayer> take_body();

 private:
  enum class Side : std::uint8_t { kLeft, kRight };
  static float sign_of(Side side) { return side == Side::kLeft ? 1.0f : -1.0f; }

  Eigen::Vector3f at(Bone bone, const Eigen::Vector3f& local_m) const {
    return places_.at(bone) + places_.scale * local_m;
  }
  FigurePart part(const Eigen::Vector3f& a_m, float radius_a_m, const Eigen::Vector3f& b_m,
                  float radius_b_m, float width = 1.0f, float depth = 1.0f) const;
  // Across the body: width along X; of an arm: along Z.
  FigureLayer& layer(Material material, float cell_m, float blend_m,
                     FigureSkinning skinning = FigureSkinning::kBody);

  void add_torso(FigureLayer& top) const;
  // A hem that hangs over the trousers, so that no gap shows between two clothes of equal width.
  void add_hem(FigureLayer& top) const;
  void add_caps(FigureLayer& top) const;  // of a top without sleeves
  // kOwn: the top has edges; kTrimmed: its figure adds bands and edgings.
  enum class Edges : std::uint8_t { kOwn, kTrimmed };
  void add_top_and_ends(Edges edges);
  void add_trousers();
  void add_fingers();
  void add_sleeve(Side side, FigureLayer& top) const;
  void add_arm(Side side);
  void add_hand(Side side, FigureLayer& skin) const;
  void add_finger(std::size_t finger);
  void add_hips(FigureLayer& legs) const;
  // A leg's radius at one of its bones, reduced so that the legs do not touch.
  float beside_other_leg(Bone bone, float radius_m) const;
  void add_trouser_leg(Side side, FigureLayer& legs) const;
  // `begin` is a share of the thigh.
  void add_bare_leg(Side side, float begin, FigureLayer& skin) const;
  void add_shorts();
  void add_skirt();
  void add_shoe(Side side);
  void add_head();
  void add_face();
  void add_hair();

  const Skeleton& skeleton_;
  const GuestLook& look_;
  const bool has_fingers_;
  const TposePlaces places_;
  std::vector<FigureLayer> layers_;
};

}  // namespace dance
