#include "formats/body/figure_builder.h"

#include <algorithm>
#include <iterator>

#include "formats/body/hand_layout.h"

namespace dance {

using Eigen::Vector3f;

namespace {
constexpr float kReferenceHeight_m = 1.72f;
constexpr float kReferenceShoulders_m = 0.35f;
}  // namespace

TposePlaces::TposePlaces(const Skeleton& skeleton) {
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    bones_m[b] = skeleton.offset_m[b];
    if (kBones[b].parent >= 0) bones_m[b] += bones_m[static_cast<std::size_t>(kBones[b].parent)];
  }
  for (std::size_t t = 0; t < kTipCount; ++t) tips_m[t] = at(kTipBones[t]) + skeleton.tip_m[t];
  scale = std::clamp(standing_height_m(skeleton) / kReferenceHeight_m, 0.3f, 3.0f);
  const float shoulders_m = (at(Bone::kLeftUpperArm) - at(Bone::kRightUpperArm)).norm();
  breadth = std::clamp(shoulders_m / scale / kReferenceShoulders_m, 0.75f, 1.2f);
}

FigureBuilder::FigureBuilder(const Skeleton& skeleton, const GuestLook& look, bool has_fingers)
    : skeleton_(skeleton), look_(look), has_fingers_(has_fingers), places_(skeleton) {}

FigurePart FigureBuilder::part(const Vector3f& a_m, float radius_a_m, const Vector3f& b_m,
                               float radius_b_m, float width, float depth) const {
  FigurePart part;
  part.a_m = a_m;
  part.b_m = b_m;
  part.radius_a_m = places_.scale * radius_a_m;
  part.radius_b_m = places_.scale * radius_b_m;
  part.width = width;
  part.depth = depth;
  return part;
}

FigureLayer& FigureBuilder::layer(Material material, float cell_m, float blend_m,
                                  FigureSkinning skinning) {
  FigureLayer layer;
  layer.material = material;
  layer.cell_m = places_.scale * cell_m;
  layer.blend_m = places_.scale * blend_m;
  layer.skinning = skinning;
  layers_.push_back(std::move(layer));
  return layers_.back();
}

void FigureBuilder::add_torso(FigureLayer& top) const {
  // Ribs that reach beyond the shoulders would swallow a hanging arm.
  const float waist = 1.34f * (0.5f + 0.5f * places_.breadth);
  const float ribs = 1.34f * places_.breadth;
  // The shirt ends at the waist, also if the back's first joint lies between the hips.
  const Vector3f hem = at(Bone::kHips, {0, 0.085f, 0});
  const auto above_hem = [&](const Vector3f& place) {
    return Vector3f(place.x(), std::max(place.y(), hem.y()), place.z());
  };
  const Vector3f middle = above_hem(at(Bone::kChest, {0, 0.01f, 0.003f}));
  top.parts.push_back(
      part(hem, 0.096f, above_hem(at(Bone::kSpine, {0, -0.005f, 0.002f})), 0.098f, waist));
  top.parts.push_back(
      part(above_hem(at(Bone::kSpine, {0, -0.01f, 0.002f})), 0.097f, middle, 0.1f, waist));
  top.parts.push_back(part(middle, 0.1f, at(Bone::kUpperChest, {0, 0.03f, 0.006f}), 0.114f, ribs));
  const Vector3f breastbone = at(Bone::kUpperChest, {0, -0.005f, 0.026f});
  top.parts.push_back(part(breastbone, 0.1f, breastbone, 0.1f, ribs));
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const float s = sign_of(side);
    const Vector3f shoulder =
        places_.at(side == Side::kLeft ? Bone::kLeftUpperArm : Bone::kRightUpperArm);
    const Vector3f girdle = at(Bone::kUpperChest, {0.045f * s, 0.06f, -0.002f});
    top.parts.push_back(part(girdle, 0.082f, girdle + 0.85f * (shoulder - girdle), 0.058f));
    const Vector3f neck = at(Bone::kNeck, {0.008f * s, 0.0f, -0.006f});
    top.parts.push_back(part(neck, 0.05f, neck + 0.8f * (shoulder - neck), 0.037f));
  }
}

void FigureBuilder::add_hem(FigureLayer& top) const {
  top.hem_y_m = at(Bone::kHips, {0, 0.015f, 0}).y();
  top.parts.push_back(part(at(Bone::kHips, {0, -0.06f, -0.006f}), 0.128f,
                           at(Bone::kHips, {0, 0.085f, 0}), 0.099f, 1.52f));
}

// The caps meet the arms steeply enough for a sharp edge in every pose of the arms.
void FigureBuilder::add_caps(FigureLayer& top) const {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const bool left = side == Side::kLeft;
    const Vector3f shoulder = places_.at(left ? Bone::kLeftUpperArm : Bone::kRightUpperArm);
    FigurePart cap = part(shoulder, 0.0605f, shoulder, 0.0605f);
    cap.limb = left ? FigureLimb::kLeftArm : FigureLimb::kRightArm;
    top.parts.push_back(cap);
  }
}

void FigureBuilder::add_hips(FigureLayer& legs) const {
  legs.parts.push_back(part(at(Bone::kHips, {0, -0.045f, 0}), 0.112f,
                            at(Bone::kHips, {0, 0.075f, 0}), 0.104f, 1.42f));
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Bone leg = side == Side::kLeft ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
    FigurePart seat = part(at(leg, {-0.01f * sign_of(side), 0.02f, -0.022f}), 0.088f,
                           at(leg, {0.0f, -0.06f, -0.012f}), 0.087f);
    seat.limb = side == Side::kLeft ? FigureLimb::kLeftLeg : FigureLimb::kRightLeg;
    legs.parts.push_back(seat);
  }
}

void FigureBuilder::add_top_and_ends(Edges edges) {
  FigureLayer top;
  top.material = Material::kTop;
  top.cell_m = places_.scale * 0.014f;
  top.blend_m = places_.scale * 0.035f;
  top.skinning = FigureSkinning::kTop;
  add_torso(top);
  if (edges == Edges::kOwn && look_.legwear != Legwear::kSkirt) add_hem(top);
  if (edges == Edges::kOwn && look_.sleeves == Sleeves::kNone) add_caps(top);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    add_sleeve(side, top);
    add_arm(side);
    add_shoe(side);
  }
  layers_.push_back(std::move(top));
}

void FigureBuilder::add_trousers() {
  FigureLayer& legs = layer(Material::kLegs, 0.014f, 0.03f);
  add_hips(legs);
  add_trouser_leg(Side::kLeft, legs);
  add_trouser_leg(Side::kRight, legs);
}

void FigureBuilder::add_fingers() {
  if (has_fingers_)
    for (std::size_t finger = 0; finger < kFingerCount; ++finger) add_finger(finger);
}

std::vector<FigureLayer> FigureBuilder::take() {
  std::vector<FigureLayer> below = take_below_head();
  add_head();
  add_face();
  add_hair();
  below.insert(below.end(), std::make_move_iterator(layers_.begin()),
               std::make_move_iterator(layers_.end()));
  return below;
}

std::vector<FigureLayer> FigureBuilder::take_below_head() {
  add_top_and_ends(Edges::kOwn);
  if (look_.legwear == Legwear::kSkirt) {
    // They begin below the hip, so that the cloth covers that end however far the leg is lifted.
    constexpr float kBelowCloth = 0.55f;
    FigureLayer& skin = layer(Material::kSkin, 0.013f, 0.02f);
    add_bare_leg(Side::kLeft, kBelowCloth, skin);
    add_bare_leg(Side::kRight, kBelowCloth, skin);
    add_skirt();
  } else {
    add_trousers();
  }
  add_fingers();
  return std::exchange(layers_, {});
}

std::vector<FigureLayer> FigureBuilder::take_body() {
  add_top_and_ends(Edges::kTrimmed);
  if (look_.legwear == Legwear::kSkirt) {
    constexpr float kBelowShorts = 0.16f;
    FigureLayer& skin = layer(Material::kSkin, 0.013f, 0.02f);
    add_bare_leg(Side::kLeft, kBelowShorts, skin);
    add_bare_leg(Side::kRight, kBelowShorts, skin);
    add_shorts();
  } else {
    add_trousers();
  }
  add_fingers();
  return std::move(layers_);
}

}  // namespace dance
