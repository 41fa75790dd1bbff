#include "formats/avatar/make/avatar_maker.h"

#include <cmath>

#include "formats/avatar/make/bent_figure.h"
#include "formats/avatar/make/cloth_map.h"
#include "formats/avatar/make/cloth_picture.h"
#include "formats/avatar/make/edging.h"
#include "formats/avatar/make/face/face_maker.h"
#include "formats/avatar/make/face/hair_maker.h"
#include "formats/avatar/make/model_builder.h"
#include "formats/avatar/make/skirt_maker.h"
#include "formats/body/body_mesh.h"

namespace dance {

using Eigen::Vector3f;

namespace {

bool has_skirt(const AvatarDesign& design) { return design.look.legwear == Legwear::kSkirt; }

// How many triangles a layer may have, chosen by eye: the most that 30 dancers on a floor need.
std::size_t budget_of(const FigureLayer& layer, bool below_skirt) {
  if (layer.skinning == FigureSkinning::kFinger) return 88;
  switch (layer.material) {
    case Material::kTop:
      return below_skirt ? 900 : 1100;
    case Material::kLegs:
      return below_skirt ? 420 : 1250;
    case Material::kShoes:
      return 260;
    case Material::kSoles:
      return 110;
    default:
      return 520;
  }
}

class AvatarMaker {
 public:
  explicit AvatarMaker(const AvatarDesign& design)
      : design_(design),
        skeleton_(average_skeleton(design.height_m)),
        places_(skeleton_),
        bent_(skeleton_),
        builder_(skeleton_) {}

  AvatarModel make() {
    add_materials();
    add_colliders();
    std::vector<FigureLayer> layers = FigureBuilder(skeleton_, design_.look, true).take_body();
    shape(layers);
    add_body(layers);
    add_head();
    add_cloth(layers);
    return builder_.take(design_.name, kAvatarLicence);
  }

 private:
  int toon(const std::string& name, const Vector3f& colour, float shade, int picture = -1) {
    AvatarMaterial material;
    material.name = name;
    material.base_colour.head<3>() = picture < 0 ? colour : Vector3f(Vector3f::Ones());
    material.picture = picture;
    material.shading = Shading::kToon;
    // Shade of skin and cloth is warmer than their light.
    material.shade_colour =
        material.base_colour.head<3>().cwiseProduct(shade * Vector3f(1.0f, 0.86f, 0.84f));
    material.shade_shift = -0.15f;
    material.shade_toony = 0.45f;
    return builder_.add_material(std::move(material));
  }

  void add_materials() {
    const GuestLook& look = design_.look;
    const int cloth = builder_.add_picture(cloth_picture(
        design_.pattern, has_skirt(design_) ? look.legs : look.top, design_.pattern_colour));
    skin_ = toon("skin", look.skin, 0.62f);
    cloth_ = toon("cloth", Vector3f::Ones(), 0.5f, cloth);
    if (has_skirt(design_)) builder_.make_double_sided(cloth_);
    top_ = has_skirt(design_) ? toon("bodice", look.top, 0.5f) : cloth_;
    legs_ = has_skirt(design_) ? toon("shorts", 0.45f * look.legs, 0.5f)
                               : toon("trousers", look.legs, 0.5f);
    shoes_ = toon("shoes", look.shoes, 0.5f);
    soles_ = toon("soles", 0.25f * look.shoes + Vector3f::Constant(0.01f), 0.6f);
    hair_ = toon("hair", look.hair, 0.4f);
    sash_ = toon("sash", design_.sash, 0.5f);
    edging_ = toon("edging", has_skirt(design_) ? design_.sash : Vector3f(0.75f * look.top), 0.5f);
    lips_ = toon("lips", design_.lips, 0.7f);
    teeth_ = toon("teeth", Vector3f(0.85f, 0.83f, 0.78f), 0.8f);
    mouth_ = toon("mouth", Vector3f(0.09f, 0.012f, 0.015f), 0.8f);
    lashes_ = toon("lashes", Vector3f(0.012f, 0.009f, 0.008f), 0.9f);
    AvatarMaterial eyes;
    eyes.name = "eyes";
    eyes.picture = builder_.add_picture(eye_picture(design_.eyes));
    eyes.roughness = 0.3f;
    eyes.shading = Shading::kToon;
    eyes.shade_colour = Vector3f::Constant(0.7f);
    eyes.shade_shift = -0.3f;
    eyes.shade_toony = 0.3f;
    eyes_ = builder_.add_material(std::move(eyes));
  }

  void add_colliders() {
    const float scale = places_.scale;
    const auto at = [&](Bone bone, const Vector3f& local_m) -> Vector3f {
      return places_.at(bone) + scale * local_m;
    };
    for (const Bone leg : {Bone::kLeftUpperLeg, Bone::kRightUpperLeg}) {
      const Bone knee = leg == Bone::kLeftUpperLeg ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg;
      for_cloth_.push_back(builder_.add_collider(leg, at(leg, {0, 0.0f, 0.005f}),
                                                 at(knee, {0, 0.02f, 0.006f}), scale * 0.09f));
      for_cloth_.push_back(builder_.add_collider(knee, at(knee, {0, 0, 0}),
                                                 at(knee, {0, -0.2f, -0.012f}), scale * 0.06f));
    }
    for_hair_.push_back(builder_.add_collider(Bone::kHead, at(Bone::kHead, {0, 0.11f, -0.012f}),
                                              at(Bone::kHead, {0, 0.09f, 0.0f}), scale * 0.082f));
    for_hair_.push_back(
        builder_.add_collider(Bone::kUpperChest, at(Bone::kUpperChest, {-0.09f, 0.05f, -0.015f}),
                              at(Bone::kUpperChest, {0.09f, 0.05f, -0.015f}), scale * 0.085f));
    for_hair_.push_back(
        builder_.add_collider(Bone::kUpperChest, at(Bone::kUpperChest, {0, -0.03f, -0.02f}),
                              at(Bone::kUpperChest, {0, 0.08f, -0.02f}), scale * 0.1f));
  }

  // What makes the two figures out of the one that all dancers have.
  void shape(std::vector<FigureLayer>& layers) const {
    for (FigureLayer& layer : layers) {
      // A shirt ends below the band, and does not come out from under it when its dancer bends.
      if (layer.skinning == FigureSkinning::kTop)
        layer.hem_y_m = places_.at(Bone::kHips).y() + places_.scale * 0.066f;
      if (design_.face == FaceShape::kSoft) make_slender(layer);
    }
  }

  void make_slender(FigureLayer& layer) const {
    const float scale = places_.scale;
    const auto thin = [](FigurePart& part, float share) {
      part.radius_a_m *= share;
      part.radius_b_m *= share;
    };
    const bool is_top = layer.skinning == FigureSkinning::kTop;
    const float waist_y_m = places_.at(Bone::kSpine).y();
    for (FigurePart& part : layer.parts) {
      const float middle_y_m = 0.5f * (part.a_m.y() + part.b_m.y());
      const bool is_arm = part.limb == FigureLimb::kLeftArm || part.limb == FigureLimb::kRightArm;
      if (is_arm) thin(part, 0.86f);
      if (layer.material == Material::kSkin && !is_arm && layer.skinning != FigureSkinning::kFinger)
        thin(part, 0.92f);
      if (is_top && part.limb == FigureLimb::kTrunk && part.width > 1.0f)
        part.width *= std::abs(middle_y_m - waist_y_m) < scale * 0.12f ? 0.86f : 0.92f;
      // Below the bodice nothing is wider than it.
      if (layer.material == Material::kLegs && part.limb == FigureLimb::kTrunk)
        part.b_m.y() -= scale * 0.055f;
    }
    if (!is_top) return;
    for (const float s : {1.0f, -1.0f}) {
      FigurePart breast;
      breast.a_m = places_.at(Bone::kUpperChest) + scale * Vector3f(0.06f * s, -0.035f, 0.066f);
      breast.b_m = breast.a_m + scale * Vector3f(0.006f * s, -0.008f, 0.006f);
      breast.radius_a_m = scale * 0.056f;
      breast.radius_b_m = scale * 0.054f;
      layer.parts.push_back(breast);
    }
  }

  int material_of(Material material) const {
    switch (material) {
      case Material::kTop:
        return top_;
      case Material::kLegs:
        return legs_;
      case Material::kShoes:
        return shoes_;
      case Material::kSoles:
        return soles_;
      default:
        return skin_;
    }
  }

  void add_body(const std::vector<FigureLayer>& layers) {
    std::map<int, Sheet> by_material;
    for (const FigureLayer& layer : layers) {
      Sheet sheet = bent_.build_sheet(layer, budget_of(layer, has_skirt(design_)));
      if (layer.material == Material::kTop && top_ == cloth_) map_shirt(sheet, places_);
      add_to(by_material[material_of(layer.material)], sheet);
    }
    for (const auto& [material, sheet] : by_material) builder_.add_sheet(sheet, material);
  }

  void add_head() {
    const FaceSurface face(places_, design_);
    const FaceMaker features(face, design_);
    std::array<int, 2> eyes{};
    for (std::size_t eye = 0; eye < 2; ++eye)
      eyes[eye] =
          builder_.add_node(eye == 0 ? "leftEye" : "rightEye", kHeadJoint, features.eye_m(eye));
    builder_.set_eyes(eyes[0], eyes[1]);
    Sheet head = bent_.build_sheet(face.layer(), 1250);
    features.add_jaw(head);
    add_to(head, features.lids());
    constexpr FirstPerson kSeenByOthers = FirstPerson::kThirdPersonOnly;
    builder_.add_sheet(head, skin_, kSeenByOthers);
    builder_.add_sheet(features.eyeballs(eyes), eyes_, kSeenByOthers);
    builder_.add_sheet(features.lashes(), lashes_, kSeenByOthers);
    builder_.add_sheet(features.brows(), hair_, kSeenByOthers);
    builder_.add_sheet(features.mouth_inside(), mouth_, kSeenByOthers);
    builder_.add_sheet(features.teeth(), teeth_, kSeenByOthers);
    builder_.add_sheet(features.lips(), lips_, kSeenByOthers);
    Sheet hair = bent_.build_sheet(hair_layer(face, design_.look.hair_style), 850);
    add_to(hair, swinging_hair(face, design_.look.hair_style, builder_, for_hair_));
    builder_.add_sheet(hair, hair_, kSeenByOthers);
  }

  void add_cloth(const std::vector<FigureLayer>& layers) {
    std::vector<FigureLayer> clothes;
    for (const FigureLayer& layer : layers)
      if (layer.material == Material::kTop || layer.material == Material::kLegs)
        clothes.push_back(layer);
    add_edgings(layers);
    const SkirtMaker maker(skeleton_, clothes);
    builder_.add_sheet(maker.band(), sash_);
    if (has_skirt(design_)) {
      builder_.add_sheet(maker.skirt(builder_, for_cloth_), cloth_);
      return;
    }
    builder_.add_sheet(maker.sash_ends(builder_, for_cloth_), builder_.add_double_sided(sash_));
    builder_.add_sheet(maker.collar(), builder_.add_double_sided(cloth_));
  }

  void add_edgings(const std::vector<FigureLayer>& layers) {
    const SkinWeighting weighting(skeleton_);
    const float tube_m = places_.scale * 0.0035f;
    const FigureLayer* top = nullptr;
    for (const FigureLayer& layer : layers)
      if (layer.skinning == FigureSkinning::kTop) top = &layer;
    const FaceSurface face(places_, design_);
    const Vector3f neck = places_.at(Bone::kNeck);
    Sheet sheet = edging({*top, face.layer(), neck - places_.scale * 0.03f * Vector3f::UnitY(),
                          neck + places_.scale * 0.09f * Vector3f::UnitY()},
                         tube_m, weighting);
    for (const FigureLayer& layer : layers) {
      if (layer.material != Material::kSkin || layer.skinning != FigureSkinning::kBody) continue;
      const FigureLimb limb = layer.parts.front().limb;
      if (limb != FigureLimb::kLeftArm && limb != FigureLimb::kRightArm) continue;
      const bool left = limb == FigureLimb::kLeftArm;
      const Vector3f shoulder = places_.at(left ? Bone::kLeftUpperArm : Bone::kRightUpperArm);
      const Vector3f wrist = places_.at(left ? Bone::kLeftHand : Bone::kRightHand);
      const Vector3f begin = shoulder - 0.06f * (wrist - shoulder);
      add_to(sheet, edging({*top, layer, begin, wrist}, tube_m, weighting));
    }
    builder_.add_sheet(sheet, edging_);
  }

  const AvatarDesign& design_;
  const Skeleton skeleton_;
  const TposePlaces places_;
  const BentFigure bent_;
  ModelBuilder builder_;
  std::vector<std::uint32_t> for_cloth_;  // colliders
  std::vector<std::uint32_t> for_hair_;
  int skin_ = 0;
  int cloth_ = 0;
  int top_ = 0;
  int legs_ = 0;
  int shoes_ = 0;
  int soles_ = 0;
  int hair_ = 0;
  int sash_ = 0;
  int edging_ = 0;
  int lips_ = 0;
  int teeth_ = 0;
  int mouth_ = 0;
  int lashes_ = 0;
  int eyes_ = 0;
};

}  // namespace

AvatarModel make_avatar(const AvatarDesign& design) { return AvatarMaker(design).make(); }

}  // namespace dance
