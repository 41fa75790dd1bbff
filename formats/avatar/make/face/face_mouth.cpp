#include <cmath>

#include "formats/avatar/make/face/face_maker.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kMouthHeight_m = 0.0375f;
constexpr int kMouthColumns = 15;
constexpr std::array<const char*, 10> kMouthMorphs{"aa",    "ih",  "ou",      "ee",        "oh",
                                                   "happy", "sad", "relaxed", "surprised", "angry"};

float column_at(int column) {
  return 2.0f * static_cast<float>(column) / static_cast<float>(kMouthColumns - 1) - 1.0f;
}

}  // namespace

FaceMaker::MouthShape FaceMaker::mouth_at_rest() const {
  return {is_strong_ ? 0.0235f : 0.0215f, 0.0f, 0.0f, 0.0016f};
}

FaceMaker::MouthShape FaceMaker::mouth_of(const std::string& morph) const {
  const MouthShape rest = mouth_at_rest();
  const float w = rest.half_width_m;
  const float c = rest.corner_m;
  if (morph == "aa") return {0.92f * w, 0.003f, 0.0145f, c};
  if (morph == "ih") return {1.05f * w, 0.002f, 0.005f, c};
  if (morph == "ou") return {0.5f * w, 0.003f, 0.005f, c};
  if (morph == "ee") return {1.18f * w, 0.002f, 0.0035f, c + 0.001f};
  if (morph == "oh") return {0.62f * w, 0.004f, 0.011f, c};
  if (morph == "happy") return {1.22f * w, 0.0005f, 0.0065f, c + 0.0058f};
  if (morph == "sad") return {0.95f * w, 0.0f, 0.0f, c - 0.0062f};
  if (morph == "relaxed") return {1.06f * w, 0.0f, 0.0f, c + 0.0028f};
  if (morph == "surprised") return {0.58f * w, 0.0035f, 0.01f, c};
  if (morph == "angry") return {0.95f * w, 0.0015f, 0.0025f, c - 0.004f};
  return rest;
}

float FaceMaker::lip_edge_m(const MouthShape& shape, Lip lip, float t) const {
  const float open_m = lip == Lip::kUpper ? shape.up_m : -shape.down_m;
  const float arch = std::sqrt(std::max(0.0f, 1.0f - t * t));
  // Corners hang on the curve that a smile bends.
  return kMouthHeight_m + shape.corner_m * t * t + open_m * arch;
}

std::vector<Vector3f> FaceMaker::lip_places(const MouthShape& shape, Lip lip) const {
  const bool upper = lip == Lip::kUpper;
  const float full_m = upper ? (is_strong_ ? 0.005f : 0.0062f) : (is_strong_ ? 0.0062f : 0.0075f);
  std::vector<Vector3f> places;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < kMouthColumns; ++column) {
      const float t = column_at(column);
      const float arch = std::pow(std::max(0.0f, 1.0f - t * t), 0.7f);
      // A cupid's bow: the upper lip is a little lower in its middle.
      const float bow = upper ? 1.0f - 0.22f * std::exp(-t * t * 30.0f) : 1.0f;
      const float height_m = full_m * arch * bow;
      // Rows from the edge at the inside outwards.
      const float share = std::array{0.0f, 0.28f, 0.65f, 1.0f}[static_cast<std::size_t>(row)];
      const float lift_m =
          std::array{0.0016f, 0.0036f, 0.0034f, 0.0002f}[static_cast<std::size_t>(row)] *
          (0.35f + 0.65f * arch);
      const float y_m = lip_edge_m(shape, lip, t) + (upper ? height_m : -height_m) * share;
      places.push_back(surface_.on(shape.half_width_m * t * (1.0f - 0.02f * share), y_m, lift_m));
    }
  if (!upper) {  // rows go up
    std::vector<Vector3f> turned;
    for (int row = 3; row >= 0; --row)
      turned.insert(turned.end(), places.begin() + row * kMouthColumns,
                    places.begin() + (row + 1) * kMouthColumns);
    places = std::move(turned);
  }
  return places;
}

// What lies between the lips: from the upper one down by a share of the opening.
std::vector<Vector3f> FaceMaker::inside_places(const MouthShape& shape, float lift_m,
                                               float share) const {
  std::vector<Vector3f> places;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < kMouthColumns; ++column) {
      const float t = column_at(column);
      const float upper_m = lip_edge_m(shape, Lip::kUpper, t);
      const float lower_m = lip_edge_m(shape, Lip::kLower, t);
      const float y_m = row == 1 ? upper_m : upper_m + share * (lower_m - upper_m);
      places.push_back(surface_.on(shape.half_width_m * t, y_m, lift_m));
    }
  return places;
}

Sheet FaceMaker::lips() const {
  Sheet sheet;
  for (const Lip lip : {Lip::kUpper, Lip::kLower}) {
    Sheet one = points_of(lip_places(mouth_at_rest(), lip), kHeadJoint);
    for (const char* morph : kMouthMorphs) one.shapes[morph] = lip_places(mouth_of(morph), lip);
    join_rows(one, 0, 4, kMouthColumns, RowEnds::kOpen);
    set_normals(one);
    add_to(sheet, one);
  }
  return sheet;
}

Sheet FaceMaker::mouth_inside() const {
  Sheet sheet = points_of(inside_places(mouth_at_rest(), 0.0009f, 1.0f), kHeadJoint);
  for (const char* morph : kMouthMorphs)
    sheet.shapes[morph] = inside_places(mouth_of(morph), 0.0009f, 1.0f);
  join_rows(sheet, 0, 2, kMouthColumns, RowEnds::kOpen);
  return sheet;
}

Sheet FaceMaker::teeth() const {
  Sheet sheet = points_of(inside_places(mouth_at_rest(), 0.0013f, 0.0f), kHeadJoint);
  for (const char* morph : kMouthMorphs) {
    const std::string name = morph;
    // A smile shows them, a rounded mouth hides them.
    const float share = name == "happy"                ? 0.62f
                        : name == "ee" || name == "ih" ? 0.7f
                        : name == "angry"              ? 0.9f
                        : name == "aa"                 ? 0.25f
                                                       : 0.0f;
    sheet.shapes[name] = inside_places(mouth_of(name), 0.0013f, share);
  }
  join_rows(sheet, 0, 2, kMouthColumns, RowEnds::kOpen);
  return sheet;
}

void FaceMaker::add_jaw(Sheet& head) const {
  const std::map<std::string, float> drops_m{
      {"aa", 0.009f}, {"oh", 0.007f}, {"surprised", 0.006f}, {"happy", 0.002f}, {"ih", 0.002f}};
  const Vector3f middle = surface_.at({0, kMouthHeight_m, 0});
  for (const auto& [name, drop_m] : drops_m) {
    std::vector<Vector3f>& places = head.shapes[name];
    for (const AvatarVertex& vertex : head.vertices) {
      const Vector3f from = (vertex.place_m - middle) / surface_.scale();
      // Chin and jaw, not the neck behind them.
      const float low = smooth_step(0.004f, -0.022f, from.y());
      const float front = smooth_step(0.01f, 0.04f, from.z());
      const float above_neck = smooth_step(-0.075f, -0.05f, from.y());
      places.push_back(vertex.place_m -
                       surface_.scale() * drop_m * low * front * above_neck * Vector3f::UnitY());
    }
  }
}

}  // namespace dance
