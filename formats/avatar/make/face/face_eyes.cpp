#include <cmath>

#include "formats/avatar/make/face/face_maker.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kEye_m = 0.0168f;
constexpr float kProtrudes_m = 0.0062f;
constexpr float kEyeAside_m = 0.0315f;
constexpr float kEyeHeight_m = 0.088f;
constexpr int kLidColumns = 11;
constexpr int kLidRows = 5;
constexpr float kCorner_deg = 72.0f;
constexpr std::array<const char*, 7> kLidMorphs{"blinkLeft", "blinkRight", "happy",    "angry",
                                                "sad",       "relaxed",    "surprised"};

float sign_of(std::size_t side) { return side == 0 ? 1.0f : -1.0f; }

Sheet build_sheet(const std::vector<Vector3f>& at_rest,
                  const std::map<std::string, std::vector<Vector3f>>& shapes) {
  Sheet sheet = points_of(at_rest, kHeadJoint);
  sheet.shapes = shapes;
  return sheet;
}

// Lit like the eyeball below it, a lower lid would look like a dark bag below the eye.
void light_as_cheek(Sheet& lid) {
  constexpr float kForward = 1.5f;
  for (AvatarVertex& vertex : lid.vertices)
    vertex.normal = (vertex.normal + kForward * Vector3f::UnitZ()).normalized();
}

}  // namespace

FaceMaker::FaceMaker(const FaceSurface& surface, const AvatarDesign& design)
    : surface_(surface), is_strong_(design.face == FaceShape::kStrong) {
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const float x_m = kEyeAside_m * sign_of(eye);
    const Vector3f inward(0.12f * sign_of(eye), 0.0f, 1.0f);
    eyes_m_[eye] = surface.on(x_m, kEyeHeight_m, 0.0f) -
                   surface.scale() * (kEye_m - kProtrudes_m) * inward.normalized();
  }
}

Vector3f FaceMaker::on_eye(std::size_t eye, float yaw_deg, float pitch_deg, float radii) const {
  const float yaw = yaw_deg * kRadians;
  const float pitch = pitch_deg * kRadians;
  const Vector3f direction(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                           std::cos(yaw) * std::cos(pitch));
  return eyes_m_[eye] + surface_.scale() * kEye_m * radii * direction;
}

Sheet FaceMaker::eyeballs(const std::array<int, 2>& joints) const {
  constexpr int kRings = 6;
  constexpr float kCap_deg = 84.0f;
  return eye_rings(joints, kCap_deg, 0.0f, kRings);
}

Sheet FaceMaker::eye_rings(const std::array<int, 2>& joints, float outer_deg, float inner_deg,
                           int rings) const {
  constexpr int kSides = 16;
  Sheet sheet;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    Sheet ball;
    for (int ring = 0; ring <= rings; ++ring)
      for (int side = 0; side < kSides; ++side) {
        // Rings go from the back to the front, where the sides of a cap meet.
        const float polar = kRadians * inner_deg +
                            kRadians * (outer_deg - inner_deg) *
                                (1.0f - static_cast<float>(ring) / static_cast<float>(rings));
        const float turn = 2.0f * kRadians * 180.0f * static_cast<float>(side) / kSides;
        const Vector3f out(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                           std::cos(polar));
        AvatarVertex vertex = vertex_at(eyes_m_[eye] + surface_.scale() * kEye_m * out,
                                        {0.5f + 0.5f * out.x(), 0.5f - 0.5f * out.y()});
        vertex.normal = out;
        tie(vertex, joints[eye]);
        ball.vertices.push_back(vertex);
      }
    join_rows(ball, 0, static_cast<std::uint32_t>(rings) + 1, kSides, RowEnds::kJoined);
    // The last ring of a cap is one point.
    std::vector<std::uint32_t> whole;
    for (std::size_t t = 0; t < ball.triangles.size(); t += 3) {
      const auto* v = &ball.triangles[t];
      const auto place = [&](int k) { return ball.vertices[v[k]].place_m; };
      if ((place(1) - place(0)).cross(place(2) - place(0)).norm() > 1e-10f)
        whole.insert(whole.end(), v, v + 3);
    }
    ball.triangles = whole;
    add_to(sheet, ball);
  }
  return sheet;
}

Sheet FaceMaker::eye_lights() const {
  constexpr int kSides = 6;
  constexpr float kAside_deg = 9.0f, kAbove_deg = 11.0f, kHalf_deg = 4.5f;
  constexpr float kRadii = 1.03f;
  Sheet sheet;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    std::vector<Vector3f> rim;
    for (int side = 0; side < kSides; ++side) {
      const float turn = kTwoPi * static_cast<float>(side) / kSides;
      rim.push_back(on_eye(eye, kAside_deg + kHalf_deg * std::cos(turn),
                           kAbove_deg + kHalf_deg * std::sin(turn), kRadii));
    }
    Sheet light = points_of(rim, kHeadJoint);
    for (std::uint32_t side = 1; side + 1 < kSides; ++side)
      light.triangles.insert(light.triangles.end(), {0, side, side + 1});
    set_normals(light);
    add_to(sheet, light);
  }
  return sheet;
}

FaceMaker::LidShape FaceMaker::lids_at_rest() const {
  return is_strong_ ? LidShape{26.0f, -22.0f, 1.0f} : LidShape{34.0f, -26.0f, 5.0f};
}

FaceMaker::LidShape FaceMaker::lids_of(const std::string& morph, std::size_t eye) const {
  LidShape shape = lids_at_rest();
  const bool blinks = morph == (eye == 0 ? "blinkLeft" : "blinkRight");
  if (blinks) shape = {-15.0f, -13.0f, 0.0f};
  if (morph == "happy") shape = {shape.upper_deg - 8.0f, shape.lower_deg + 13.0f, shape.slant_deg};
  if (morph == "angry") shape = {shape.upper_deg - 5.0f, shape.lower_deg + 5.0f, 12.0f};
  if (morph == "sad") shape = {shape.upper_deg - 6.0f, shape.lower_deg, -12.0f};
  if (morph == "relaxed") shape = {shape.upper_deg - 16.0f, shape.lower_deg + 3.0f, 2.0f};
  if (morph == "surprised") shape = {shape.upper_deg + 14.0f, shape.lower_deg - 8.0f, 2.0f};
  return shape;
}

// Lids meet in the corners of the eye.
float FaceMaker::rim_deg(const LidShape& shape, bool upper, float yaw_deg, std::size_t eye) const {
  const float t = yaw_deg / kCorner_deg;
  const float arch = 1.0f - t * t;
  const float outwards = t * sign_of(eye);
  const float corner_deg = -2.0f + 4.0f * outwards;
  const float middle_deg = upper ? shape.upper_deg : shape.lower_deg;
  return corner_deg + (middle_deg + 2.0f) * arch +
         (upper ? shape.slant_deg * outwards * (0.3f + arch) : 0.0f);
}

std::vector<Vector3f> FaceMaker::lid_places(std::size_t eye, const LidShape& shape,
                                            bool upper) const {
  constexpr float kBack_deg = 88.0f;
  std::vector<Vector3f> places;
  // From the edge at the eyeball out to the rim, and back into the head.
  for (int row = 0; row < kLidRows; ++row)
    for (int column = 0; column < kLidColumns; ++column) {
      const float yaw_deg =
          kCorner_deg *
          (2.0f * static_cast<float>(column) / static_cast<float>(kLidColumns - 1) - 1.0f);
      const float rim = rim_deg(shape, upper, yaw_deg, eye);
      const float back = upper ? kBack_deg : -kBack_deg;
      const float share =
          row < 2 ? 0.0f : static_cast<float>(row - 1) / static_cast<float>(kLidRows - 2);
      // The lower lid is thin, and no bag.
      const float rim_radii = upper ? 1.12f : 1.06f;
      const float radii = row == 0 ? 1.0f : rim_radii - (upper ? 0.02f : 0.05f) * share;
      places.push_back(on_eye(eye, yaw_deg, rim + share * (back - rim), radii));
    }
  if (!upper) {  // rows go up
    std::vector<Vector3f> turned;
    for (int row = kLidRows - 1; row >= 0; --row)
      turned.insert(turned.end(), places.begin() + row * kLidColumns,
                    places.begin() + (row + 1) * kLidColumns);
    places = std::move(turned);
  }
  return places;
}

std::vector<Vector3f> FaceMaker::lash_places(std::size_t eye, const LidShape& shape) const {
  std::vector<Vector3f> places;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < kLidColumns; ++column) {
      const float t =
          2.0f * static_cast<float>(column) / static_cast<float>(kLidColumns - 1) - 1.0f;
      const float outwards = t * sign_of(eye);
      const float rim = rim_deg(shape, true, kCorner_deg * t, eye);
      // Longer towards the outer corner.
      const float length = (is_strong_ ? 0.035f : 0.09f) * (0.5f + 0.5f * (outwards + 1.0f) * 0.9f);
      const float yaw_deg = kCorner_deg * t + (row == 1 && !is_strong_ ? 5.0f * outwards : 0.0f);
      const float pitch_deg = rim + (row == 0 ? -2.0f : row == 1 ? 1.0f + 30.0f * length : 7.0f);
      const float radii = row == 0 ? 1.07f : row == 1 ? 1.13f + length : 1.125f;
      places.push_back(on_eye(eye, yaw_deg, pitch_deg, radii));
    }
  return places;
}

Sheet FaceMaker::lids() const {
  Sheet sheet;
  for (std::size_t eye = 0; eye < 2; ++eye)
    for (const bool upper : {true, false}) {
      std::map<std::string, std::vector<Vector3f>> shapes;
      for (const char* morph : kLidMorphs)
        shapes[morph] = lid_places(eye, lids_of(morph, eye), upper);
      Sheet lid = build_sheet(lid_places(eye, lids_at_rest(), upper), shapes);
      join_rows(lid, 0, kLidRows, kLidColumns, RowEnds::kOpen);
      set_normals(lid);
      if (!upper) light_as_cheek(lid);
      add_to(sheet, lid);
    }
  return sheet;
}

Sheet FaceMaker::lashes() const {
  Sheet sheet;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    std::map<std::string, std::vector<Vector3f>> shapes;
    for (const char* morph : kLidMorphs) shapes[morph] = lash_places(eye, lids_of(morph, eye));
    Sheet lash = build_sheet(lash_places(eye, lids_at_rest()), shapes);
    join_rows(lash, 0, 3, kLidColumns, RowEnds::kOpen);
    set_normals(lash);
    add_to(sheet, lash);
  }
  return sheet;
}

std::vector<Vector3f> FaceMaker::brow_places(std::size_t side, const BrowShape& shape) const {
  constexpr int kColumns = 8;
  const float thick_m = is_strong_ ? 0.0042f : 0.0028f;
  std::vector<Vector3f> places;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const float t = static_cast<float>(column) / static_cast<float>(kColumns - 1);
      // Columns go to the right: outwards on the left side of the face, inwards on the other.
      const float outwards = side == 0 ? t : 1.0f - t;
      const float x_m = (0.013f + 0.037f * outwards) * sign_of(side);
      const float arch_m = (is_strong_ ? 0.0035f : 0.0065f) * std::sin(2.6f * outwards);
      const float moved_m = shape.inner_m + outwards * (shape.outer_m - shape.inner_m);
      const float half_m = thick_m * (1.0f - 0.8f * outwards * outwards) *
                           (0.55f + 0.45f * smooth_step(0.0f, 0.25f, outwards));
      const float y_m = 0.1145f + arch_m - 0.002f * outwards + moved_m;
      places.push_back(surface_.on(x_m, y_m + half_m * static_cast<float>(row - 1),
                                   row == 1 ? 0.0035f : 0.0004f));
    }
  return places;
}

Sheet FaceMaker::brows() const {
  const std::map<std::string, BrowShape> moves{{"happy", {0.002f, 0.004f}},
                                               {"angry", {-0.0075f, 0.004f}},
                                               {"sad", {0.008f, -0.004f}},
                                               {"relaxed", {0.001f, -0.001f}},
                                               {"surprised", {0.01f, 0.01f}}};
  Sheet sheet;
  for (std::size_t side = 0; side < 2; ++side) {
    std::map<std::string, std::vector<Vector3f>> shapes;
    for (const auto& [name, move] : moves) shapes[name] = brow_places(side, move);
    Sheet brow = build_sheet(brow_places(side, {}), shapes);
    join_rows(brow, 0, 3, 8, RowEnds::kOpen);
    set_normals(brow);
    add_to(sheet, brow);
  }
  return sheet;
}

}  // namespace dance
