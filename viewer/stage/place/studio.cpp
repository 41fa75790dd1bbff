#include "viewer/stage/place/place_builder.h"
#include "viewer/stage/place/places.h"

namespace dance::studio_place {

using Eigen::Vector3f;

namespace {

constexpr float kHeight_m = 3.7f;
const Vector3f kPlaster(0.56f, 0.50f, 0.43f);
const Vector3f kOak(0.33f, 0.19f, 0.10f);
const Vector3f kDarkOak(0.15f, 0.085f, 0.045f);
const Vector3f kWarm(1.0f, 0.80f, 0.58f);
constexpr float kBarDepth_m = 0.35f;

// The lower part of a wall is wood, the upper part plaster.
void add_wall(PlaceBuilder& build, PlaceSide side) {
  const float width = build.width_m(side);
  build.add_panel({0.0f, width, 1.0f, kHeight_m}, 0.0f, kPlaster);
  build.add_panel({0.0f, width, 0.0f, 1.0f}, 0.0f, 0.62f * kOak);
  build.add_box({0.0f, width, 0.0f, 0.12f}, 0.0f, 0.03f, kDarkOak);
  build.add_box({0.0f, width, 0.97f, 1.03f}, 0.0f, 0.035f, kOak);
}

void add_cove(PlaceBuilder& build, PlaceSide side) {
  const float width = build.width_m(side);
  build.add_bright_panel({0.3f, width - 0.3f, 3.30f, 3.36f}, 0.09f, 1.3f * kWarm, 1.3f * kWarm,
                         1.0f);
  build.add_box({0.2f, width - 0.2f, 3.22f, 3.30f}, 0.0f, 0.12f, kPlaster);
}

void add_mirror(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kBack);
  const PlaceRect glass{0.8f, width - 0.8f, 0.14f, 2.5f};
  // The wall round the glass.
  build.add_panel({0.0f, width, glass.top_m, kHeight_m}, 0.0f, kPlaster);
  build.add_panel({0.0f, width, 0.0f, glass.bottom_m}, 0.0f, kDarkOak);
  build.add_panel({0.0f, glass.left_m, glass.bottom_m, glass.top_m}, 0.0f, 0.9f * kPlaster);
  build.add_panel({glass.right_m, width, glass.bottom_m, glass.top_m}, 0.0f, 0.9f * kPlaster);
  // The frame of the mirror, and the joints between its panes.
  build.add_box({glass.left_m, glass.right_m, glass.top_m, glass.top_m + 0.07f}, 0.0f, 0.04f, kOak);
  build.add_box({glass.left_m, glass.right_m, glass.bottom_m - 0.07f, glass.bottom_m}, 0.0f, 0.04f,
                kOak);
  build.add_box({glass.left_m - 0.07f, glass.left_m, glass.bottom_m, glass.top_m}, 0.0f, 0.04f,
                kOak);
  build.add_box({glass.right_m, glass.right_m + 0.07f, glass.bottom_m, glass.top_m}, 0.0f, 0.04f,
                kOak);
  const int panes = static_cast<int>((glass.right_m - glass.left_m) / 2.0f);
  for (int i = 1; i < panes; ++i) {
    const float u = glass.left_m + (glass.right_m - glass.left_m) * static_cast<float>(i) /
                                       static_cast<float>(panes);
    build.add_panel({u - 0.01f, u + 0.01f, glass.bottom_m, glass.top_m}, 0.006f,
                    Vector3f::Constant(0.05f));
  }
  const PlaceRoom& room = build.shape().room;
  build.shape().mirror = {room.left_m + glass.left_m, room.left_m + glass.right_m, glass.bottom_m,
                          glass.top_m, room.back_m};
}

void add_barre(PlaceBuilder& build, float from_u, float to_u) {
  build.add_box({from_u, to_u, 1.02f, 1.065f}, 0.22f, 0.265f, 1.5f * kOak);
  for (float u = from_u + 0.4f; u < to_u; u += 2.0f)
    build.add_box({u, u + 0.035f, 0.98f, 1.02f}, 0.0f, 0.25f, kDarkOak);
}

// Dusk in tall windows.
void add_window(PlaceBuilder& build, float from_u, float to_u) {
  const float bottom = 1.03f, top = 3.0f, bar = 0.05f;
  build.add_bright_panel({from_u, to_u, bottom, top}, 0.01f, Vector3f(0.42f, 0.26f, 0.20f),
                         Vector3f(0.10f, 0.15f, 0.30f), 0.0f);
  build.add_box({from_u - bar, to_u + bar, top, top + bar}, 0.0f, 0.05f, kPlaster);
  build.add_box({from_u - 0.1f, to_u + 0.1f, bottom - 0.06f, bottom}, 0.0f, 0.16f, kOak);
  const float middle = 0.5f * (from_u + to_u);
  for (const float u : {from_u - bar, middle - 0.5f * bar, to_u})
    build.add_box({u, u + bar, bottom, top}, 0.0f, 0.05f, kPlaster);
  for (const float v : {1.68f, 2.34f})
    build.add_box({from_u, to_u, v, v + 0.035f}, 0.0f, 0.03f, kPlaster);
}

void add_windows(PlaceBuilder& build, PlaceSide side, int windows) {
  const float pitch = build.width_m(side) / static_cast<float>(windows);
  for (int i = 0; i < windows; ++i) {
    const float middle = (static_cast<float>(i) + 0.5f) * pitch;
    build.add_panel({middle - 0.9f, middle + 0.9f, 1.0f, 3.1f}, 0.004f, kPlaster);
    add_window(build, middle - 0.75f, middle + 0.75f);
  }
}

void add_picture(PlaceBuilder& build, const PlaceRect& rect, const Vector3f& below,
                 const Vector3f& above) {
  build.add_box(
      {rect.left_m - 0.05f, rect.right_m + 0.05f, rect.bottom_m - 0.05f, rect.top_m + 0.05f}, 0.0f,
      0.03f, kDarkOak);
  const auto [l, r, b, t] = rect;
  build.add_panel(rect, 0.034f, below);
  build.add_panel({l + 0.12f, r - 0.12f, b + 0.55f * (t - b), t - 0.12f}, 0.037f, above);
}

// A door, a bench, a loudspeaker and two posters.
void add_side_of_the_door(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kRight);
  const float door = 0.16f * width;
  build.add_box({door - 0.1f, door + 1.1f, 0.0f, 2.2f}, 0.0f, 0.05f, kDarkOak);
  build.add_box({door, door + 1.0f, 0.0f, 2.1f}, 0.05f, 0.07f, 0.9f * kOak);
  build.add_box({door + 0.86f, door + 0.92f, 1.0f, 1.06f}, 0.07f, 0.12f,
                Vector3f(0.5f, 0.42f, 0.25f));
  const float middle = 0.5f * width;
  add_picture(build, {middle - 0.55f, middle + 0.15f, 1.35f, 2.35f}, Vector3f(0.55f, 0.12f, 0.07f),
              Vector3f(0.80f, 0.55f, 0.20f));
  add_picture(build, {middle + 0.6f, middle + 1.3f, 1.35f, 2.35f}, Vector3f(0.06f, 0.22f, 0.30f),
              Vector3f(0.70f, 0.62f, 0.48f));
  build.add_box({middle - 0.9f, middle + 1.7f, 0.40f, 0.46f}, 0.05f, 0.45f, 1.2f * kOak);
  for (const float u : {middle - 0.8f, middle + 1.52f})
    build.add_box({u, u + 0.08f, 0.0f, 0.40f}, 0.08f, 0.42f, kDarkOak);
  const float speaker = width - 0.95f;
  build.add_box({speaker, speaker + 0.42f, 0.0f, 1.05f}, 0.15f, 0.55f, Vector3f::Constant(0.035f));
  build.add_panel({speaker + 0.07f, speaker + 0.35f, 0.18f, 0.48f}, 0.556f,
                  Vector3f::Constant(0.10f));
  build.add_panel({speaker + 0.12f, speaker + 0.30f, 0.66f, 0.86f}, 0.556f,
                  Vector3f::Constant(0.10f));
}

void add_ceiling(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kAbove);
  const float length = build.width_m(PlaceSide::kLeft);
  build.begin(PlaceSide::kAbove, 0.3f);
  build.add_panel({0.0f, width, 0.0f, length}, 0.0f, 0.55f * kPlaster);
  for (const float share : {0.25f, 0.5f, 0.75f}) {
    const float u = share * width;
    build.add_box({u - 0.1f, u + 0.1f, 0.0f, length}, 0.0f, 0.22f, kDarkOak);
    build.add_bright_panel({u - 0.05f, u + 0.05f, 0.8f, length - 0.8f}, 0.225f, 1.6f * kWarm,
                           1.6f * kWarm, 1.0f);
  }
}

void add_lamps(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kAbove);
  const float length = build.width_m(PlaceSide::kLeft);
  for (const float share : {0.25f, 0.5f, 0.75f})
    for (const float along : {0.22f, 0.5f, 0.78f})
      build.add_lamp(PlaceSide::kAbove, share * width, along * length, 0.35f, 0.24f * kWarm, 2.4f);
  for (const float share : {0.2f, 0.5f, 0.8f}) {
    build.add_lamp(PlaceSide::kBack, share * width, 3.4f, 0.25f, 0.30f * kWarm, 0.9f);
    build.add_lamp(PlaceSide::kRight, share * length, 3.4f, 0.25f, 0.30f * kWarm, 0.9f);
  }
}

}  // namespace

PlaceShape make(const PlaceRoom& room) {
  PlaceBuilder build(Venue::kStudio, room, kHeight_m);
  PlaceShape& shape = build.shape();
  shape.mood = {Vector3f(1.42f, 1.28f, 1.08f), Vector3f(0.46f, 0.45f, 0.47f),
                Vector3f(0.32f, 0.24f, 0.17f), Vector3f(0.55f, 0.56f, 0.62f)};
  shape.floor = {FloorPattern::kPlanks, Vector3f(0.40f, 0.225f, 0.115f),
                 Vector3f(0.285f, 0.145f, 0.068f), Vector3f(0.24f, 0.19f, 0.145f), 0.8f};
  shape.sky = {Vector3f(0.060f, 0.048f, 0.045f), Vector3f(0.035f, 0.032f, 0.040f),
               Vector3f(0.010f, 0.011f, 0.018f), Vector3f(0.035f, 0.030f, 0.030f)};
  add_lamps(build);
  build.begin(PlaceSide::kBack, kBarDepth_m);
  add_mirror(build);
  add_barre(build, 0.8f, build.width_m(PlaceSide::kBack) - 0.8f);
  add_cove(build, PlaceSide::kBack);
  build.begin(PlaceSide::kBack, kBarDepth_m, PlaceGroup::Kind::kGlass);
  const PlaceMirror& glass = *shape.mirror;
  build.add_bright_panel(
      {glass.left_m - room.left_m, glass.right_m - room.left_m, glass.bottom_m, glass.top_m}, 0.0f,
      Vector3f(0.11f, 0.12f, 0.125f), Vector3f(0.16f, 0.17f, 0.18f), 0.0f);
  build.begin(PlaceSide::kLeft, kBarDepth_m);
  add_wall(build, PlaceSide::kLeft);
  add_windows(build, PlaceSide::kLeft, 4);
  build.begin(PlaceSide::kRight, 0.65f);
  add_wall(build, PlaceSide::kRight);
  add_side_of_the_door(build);
  add_cove(build, PlaceSide::kRight);
  build.begin(PlaceSide::kFront, kBarDepth_m);
  add_wall(build, PlaceSide::kFront);
  add_windows(build, PlaceSide::kFront, 4);
  add_barre(build, 0.6f, build.width_m(PlaceSide::kFront) - 0.6f);
  add_ceiling(build);
  build.add_floor();
  return build.take();
}

}  // namespace dance::studio_place
