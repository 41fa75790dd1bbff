#include "formats/mcap/body_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "core/pose/shortest_turn.h"

namespace dance {
namespace {

constexpr float kTipRadius_m = 0.03f;
constexpr float kShortestLimb_m = 0.005f;

struct Colour {
  float r, g, b;
};
// Told apart also by those who do not see red and green alike (after Okabe and Ito 2008).
constexpr std::array<Colour, 8> kColours{{
    {0.90f, 0.62f, 0.00f},
    {0.34f, 0.71f, 0.91f},
    {0.00f, 0.62f, 0.45f},
    {0.94f, 0.89f, 0.26f},
    {0.00f, 0.45f, 0.70f},
    {0.84f, 0.37f, 0.00f},
    {0.80f, 0.47f, 0.65f},
    {0.75f, 0.75f, 0.75f},
}};

// Thickness where a bone begins; its end has that of the next.
float radius_m(std::size_t bone) {
  switch (static_cast<Bone>(bone)) {
    case Bone::kHips:
    case Bone::kSpine:
    case Bone::kChest:
    case Bone::kUpperChest:
      return 0.085f;
    case Bone::kLeftUpperLeg:
    case Bone::kRightUpperLeg:
      return 0.07f;
    case Bone::kLeftLowerLeg:
    case Bone::kRightLowerLeg:
    case Bone::kNeck:
    case Bone::kHead:
      return 0.05f;
    default:
      return 0.038f;
  }
}

void append_colour(JsonText& json, const Colour& colour, float alpha) {
  json.raw("\"color\":{\"r\":").number(colour.r).raw(",\"g\":").number(colour.g);
  json.raw(",\"b\":").number(colour.b).raw(",\"a\":").number(alpha).raw("}");
}

void append_pose(JsonText& json, const Eigen::Vector3f& p, const Eigen::Quaternionf& R) {
  json.raw("\"pose\":{\"position\":").xyz(p.x(), p.y(), p.z());
  json.raw(",\"orientation\":").xyzw(R.x(), R.y(), R.z(), R.w()).raw("}");
}

void begin_entity(JsonText& json, std::uint64_t time_ns) {
  json.raw("{\"timestamp\":").time(time_ns);
  json.raw(",\"lifetime\":{\"sec\":0,\"nsec\":0},\"frame_locked\":true,\"metadata\":[],");
}

Eigen::Quaternionf turn_to(const Eigen::Vector3d& axis, const Eigen::Vector3f& direction) {
  return shortest_turn(axis, direction.cast<double>()).cast<float>();
}

// A cylinder's axis is its z; it lies along the bone.
void append_limb(JsonText& json, const Eigen::Vector3f& to_m, float from_radius_m,
                 float to_radius_m, const Colour& colour) {
  const Eigen::Quaternionf along = turn_to(Eigen::Vector3d::UnitZ(), to_m);
  const float widest_m = std::max(from_radius_m, to_radius_m);
  json.raw("{");
  append_pose(json, 0.5f * to_m, along);
  json.raw(",\"size\":").xyz(2.0f * widest_m, 2.0f * widest_m, to_m.norm());
  json.raw(",\"bottom_scale\":").number(from_radius_m / widest_m);
  json.raw(",\"top_scale\":").number(to_radius_m / widest_m).raw(",");
  append_colour(json, colour, 1.0f);
  json.raw("}");
}

void append_ellipsoid(JsonText& json, const Eigen::Vector3f& at_m, const Eigen::Vector3f& size_m,
                      const Eigen::Quaternionf& turned, const Colour& colour) {
  json.raw("{");
  append_pose(json, at_m, turned);
  json.raw(",\"size\":").xyz(size_m.x(), size_m.y(), size_m.z()).raw(",");
  append_colour(json, colour, 1.0f);
  json.raw("}");
}

void append_ball(JsonText& json, const Eigen::Vector3f& at_m, float radius_m,
                 const Colour& colour) {
  append_ellipsoid(json, at_m, Eigen::Vector3f::Constant(2.0f * radius_m),
                   Eigen::Quaternionf::Identity(), colour);
}

// From the chin to the crown, with a nose that shows where the dancer looks.
void append_head(JsonText& json, const Eigen::Vector3f& tip_m, const Colour& colour) {
  constexpr float kWide = 0.68f, kDeep = 0.86f;  // of its height
  const float height_m = tip_m.norm();
  if (height_m < kShortestLimb_m) return;
  const Eigen::Quaternionf up = turn_to(Eigen::Vector3d::UnitY(), tip_m);
  append_ellipsoid(json.raw(","), 0.52f * tip_m, {kWide * height_m, height_m, kDeep * height_m}, up,
                   colour);
  const Eigen::Vector3f nose_m =
      0.45f * tip_m + up * Eigen::Vector3f(0.0f, 0.0f, 0.44f * kDeep * height_m);
  append_ball(json.raw(","), nose_m, 0.07f * height_m, colour);
}

// What a bone carries: its ball, a limb to each child and to its tip.
struct Parts {
  struct Limb {
    Eigen::Vector3f to_m;
    float radius_m;
  };
  std::array<Limb, 5> limbs;
  std::size_t count = 0;
  int tip = -1;
};

Parts parts_of(const Skeleton& skeleton, std::size_t bone) {
  Parts parts;
  const auto add = [&](const Eigen::Vector3f& to_m, float radius) {
    if (to_m.norm() > kShortestLimb_m) parts.limbs[parts.count++] = {to_m, radius};
  };
  for (std::size_t child = bone + 1; child < kBoneCount; ++child)
    if (kBones[child].parent == static_cast<int>(bone))
      add(skeleton.offset_m[child], radius_m(child));
  for (std::size_t tip = 0; tip < kTipCount; ++tip) {
    if (index_of(kTipBones[tip]) != bone) continue;
    parts.tip = static_cast<int>(tip);
    if (kTipBones[tip] != Bone::kHead) add(skeleton.tip_m[tip], kTipRadius_m);
  }
  return parts;
}

void append_name(JsonText& json, const GuestId& guest, const Skeleton& skeleton) {
  json.raw("{");
  append_pose(json, skeleton.tip(Tip::kHead) + Eigen::Vector3f(0.0f, 0.2f, 0.0f),
              Eigen::Quaternionf::Identity());
  json.raw(",\"billboard\":true,\"font_size\":0.14,\"scale_invariant\":false,");
  append_colour(json, {1.0f, 1.0f, 1.0f}, 1.0f);
  json.raw(",\"text\":").quoted(guest.view()).raw("}");
}

void append_bone(JsonText& json, const GuestId& guest, const Skeleton& skeleton, std::size_t bone,
                 const Colour& colour, std::uint64_t time_ns) {
  const Parts parts = parts_of(skeleton, bone);
  begin_entity(json, time_ns);
  json.raw("\"frame_id\":\"").raw(guest.view()).raw("/").raw(kBones[bone].name);
  json.raw("\",\"id\":\"").raw(guest.view()).raw("/").raw(kBones[bone].name);
  json.raw(
      "\",\"arrows\":[],\"cubes\":[],\"lines\":[],\"triangles\":[],\"models\":[],\"spheres\":[");
  append_ball(json, Eigen::Vector3f::Zero(), radius_m(bone), colour);
  if (static_cast<Bone>(bone) == Bone::kHead) {
    append_head(json, skeleton.tip(Tip::kHead), colour);
  } else if (parts.tip >= 0 && parts.count > 0) {
    const Parts::Limb& tip = parts.limbs[parts.count - 1];
    append_ball(json.raw(","), tip.to_m, tip.radius_m, colour);
  }
  json.raw("],\"cylinders\":[");
  for (std::size_t i = 0; i < parts.count; ++i) {
    if (i > 0) json.raw(",");
    append_limb(json, parts.limbs[i].to_m, radius_m(bone), parts.limbs[i].radius_m, colour);
  }
  json.raw("],\"texts\":[");
  if (static_cast<Bone>(bone) == Bone::kHead) append_name(json, guest, skeleton);
  json.raw("]}");
}

}  // namespace

void append_body(JsonText& json, const GuestId& guest, const Skeleton& skeleton,
                 std::size_t colour_index, std::uint64_t time_ns) {
  json.raw("{\"deletions\":[],\"entities\":[");
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    if (bone > 0) json.raw(",");
    append_bone(json, guest, skeleton, bone, kColours[colour_index % kColours.size()], time_ns);
  }
  json.raw("]}");
}

void append_floor(JsonText& json, std::uint64_t time_ns) {
  constexpr int kHalf_m = 4;
  json.raw("{\"deletions\":[],\"entities\":[");
  begin_entity(json, time_ns);
  json.raw(
      "\"frame_id\":\"stage\",\"id\":\"floor\",\"arrows\":[],\"spheres\":[],\"cylinders\":[],");
  json.raw("\"triangles\":[],\"texts\":[],\"models\":[],\"cubes\":[{");
  append_pose(json, {0.0f, -0.011f, 0.0f}, Eigen::Quaternionf::Identity());
  json.raw(",\"size\":").xyz(2.0f * kHalf_m, 0.02f, 2.0f * kHalf_m).raw(",");
  append_colour(json, {0.28f, 0.24f, 0.22f}, 1.0f);
  // Its boards, a metre apart.
  json.raw("}],\"lines\":[{\"type\":2,");
  append_pose(json, Eigen::Vector3f::Zero(), Eigen::Quaternionf::Identity());
  json.raw(",\"thickness\":0.01,\"scale_invariant\":false,\"points\":[");
  for (int at = -kHalf_m; at <= kHalf_m; ++at) {
    const auto x = static_cast<float>(at);
    const auto far = static_cast<float>(kHalf_m);
    if (at > -kHalf_m) json.raw(",");
    json.xyz(x, 0.0f, -far).raw(",").xyz(x, 0.0f, far).raw(",");
    json.xyz(-far, 0.0f, x).raw(",").xyz(far, 0.0f, x);
  }
  json.raw("],");
  append_colour(json, {0.5f, 0.45f, 0.4f}, 1.0f);
  json.raw(",\"colors\":[],\"indices\":[]}]}]}");
}

void append_no_body(JsonText& json, std::uint64_t time_ns) {
  json.raw("{\"deletions\":[{\"timestamp\":").time(time_ns);
  json.raw(",\"type\":1,\"id\":\"\"}],\"entities\":[]}");
}

}  // namespace dance
