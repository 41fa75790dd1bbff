#include <array>

#include "viewer/stage/place/place_builder.h"
#include "viewer/stage/place/places.h"

namespace dance::bar_place {

using Eigen::Vector3f;

namespace {

constexpr float kHeight_m = 3.3f;
constexpr float kCounterDepth_m = 1.5f;
const Vector3f kWall(0.105f, 0.055f, 0.050f);
const Vector3f kWood(0.16f, 0.075f, 0.035f);
const Vector3f kDarkWood(0.07f, 0.032f, 0.018f);
const Vector3f kBrass(0.55f, 0.36f, 0.14f);
const Vector3f kLamp(1.0f, 0.62f, 0.28f);
const Vector3f kBulb(2.6f, 1.55f, 0.65f);

void add_wall(PlaceBuilder& build, PlaceSide side) {
  const float width = build.width_m(side);
  build.add_panel({0.0f, width, 1.1f, kHeight_m}, 0.0f, kWall);
  build.add_panel({0.0f, width, 0.0f, 1.1f}, 0.0f, kDarkWood);
  build.add_box({0.0f, width, 1.06f, 1.12f}, 0.0f, 0.04f, kWood);
  const int boards = static_cast<int>(width / 1.2f);
  for (int i = 1; i < boards; ++i) {
    const float u = width * static_cast<float>(i) / static_cast<float>(boards);
    build.add_box({u - 0.03f, u + 0.03f, 0.0f, 1.06f}, 0.0f, 0.025f, kWood);
  }
}

// Bottles of one shelf, in repeating sizes and colours.
void add_bottles(PlaceBuilder& build, float from_u, float to_u, float v) {
  const std::array<Vector3f, 5> colours{
      Vector3f(0.50f, 0.22f, 0.04f), Vector3f(0.10f, 0.30f, 0.10f), Vector3f(0.55f, 0.42f, 0.22f),
      Vector3f(0.35f, 0.05f, 0.04f), Vector3f(0.12f, 0.25f, 0.34f)};
  int i = 0;
  for (float u = from_u; u + 0.09f < to_u; u += 0.17f, ++i) {
    const float high = 0.24f + 0.03f * static_cast<float>((i * 7) % 4);
    const Vector3f& colour = colours[static_cast<std::size_t>((i * 3) % 5)];
    build.add_bright_box({u, u + 0.085f, v, v + high}, 0.1f, 0.18f, 0.55f * colour, 0.6f);
    build.add_bright_box({u + 0.027f, u + 0.058f, v + high, v + high + 0.09f}, 0.12f, 0.15f,
                         0.35f * colour, 0.6f);
  }
}

// Shelves with light behind the bottles, and the counter in front of them.
void add_counter(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kBack);
  const float from = 0.18f * width, to = 0.82f * width;
  build.add_box({from - 0.12f, to + 0.12f, 0.95f, 2.55f}, 0.0f, 0.06f, kDarkWood);
  build.add_bright_panel({from, to, 1.05f, 2.45f}, 0.065f, 0.42f * kLamp, 0.16f * kLamp, 1.0f);
  for (const float v : {1.18f, 1.80f}) {
    build.add_box({from, to, v - 0.04f, v}, 0.06f, 0.26f, kWood);
    add_bottles(build, from + 0.15f, to - 0.1f, v);
  }
  build.add_box({from - 0.3f, to + 0.3f, 0.0f, 1.04f}, 0.85f, 1.35f, kWood);
  build.add_box({from - 0.38f, to + 0.38f, 1.04f, 1.10f}, 0.78f, 1.45f, 1.5f * kWood);
  build.add_box({from - 0.3f, to + 0.3f, 0.16f, 0.20f}, 1.35f, 1.45f, kBrass);
  const int fields = static_cast<int>((to - from) / 0.9f);
  for (int i = 0; i < fields; ++i) {
    const float u = from + (to - from) * static_cast<float>(i) / static_cast<float>(fields);
    build.add_box({u + 0.08f, u + 0.82f, 0.28f, 0.92f}, 1.35f, 1.37f, 0.75f * kWood);
  }
}

// Lamps that hang over the counter.
void add_pendants(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kBack);
  for (const float share : {0.24f, 0.37f, 0.5f, 0.63f, 0.76f}) {
    const float u = share * width;
    build.add_box({u - 0.006f, u + 0.006f, 2.18f, kHeight_m}, 1.10f, 1.11f,
                  Vector3f::Constant(0.02f));
    build.add_box({u - 0.13f, u + 0.13f, 2.02f, 2.18f}, 0.98f, 1.24f, kBrass);
    build.add_bulb(u, 1.98f, 1.11f, 0.10f, kBulb, 0.55f);
  }
}

void add_strings(PlaceBuilder& build, PlaceSide side) {
  const float width = build.width_m(side);
  const int spans = static_cast<int>(width / 2.4f);
  for (int i = 0; i < spans; ++i) {
    const float from = width * static_cast<float>(i) / static_cast<float>(spans);
    const float to = width * static_cast<float>(i + 1) / static_cast<float>(spans);
    build.add_string_of_bulbs(Vector3f(from, 3.0f, 0.25f), Vector3f(to, 3.0f, 0.25f), 0.35f, 6,
                              kBulb);
  }
}

// Small tables with a candle along a wall, and pictures over them.
void add_tables(PlaceBuilder& build, PlaceSide side) {
  const float width = build.width_m(side);
  const int tables = static_cast<int>(width / 2.4f);
  for (int i = 0; i < tables; ++i) {
    const float u = width * (static_cast<float>(i) + 0.5f) / static_cast<float>(tables);
    build.add_box({u - 0.35f, u + 0.35f, 0.70f, 0.74f}, 0.25f, 0.95f, 1.3f * kWood);
    build.add_box({u - 0.04f, u + 0.04f, 0.0f, 0.70f}, 0.55f, 0.65f, kDarkWood);
    build.add_bulb(u, 0.80f, 0.6f, 0.07f, 0.8f * kBulb, 0.35f);
    build.add_box({u - 0.42f, u + 0.42f, 1.45f, 2.15f}, 0.0f, 0.04f, kBrass);
    build.add_panel({u - 0.36f, u + 0.36f, 1.51f, 2.09f}, 0.045f,
                    i % 2 == 0 ? Vector3f(0.30f, 0.10f, 0.06f) : Vector3f(0.08f, 0.16f, 0.18f));
  }
}

// Night behind tall windows, with the lights of the street.
void add_windows(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kFront);
  const int windows = static_cast<int>(width / 3.0f);
  for (int i = 0; i < windows; ++i) {
    const float u = width * (static_cast<float>(i) + 0.5f) / static_cast<float>(windows);
    build.add_bright_panel({u - 0.8f, u + 0.8f, 1.15f, 2.7f}, 0.01f, Vector3f(0.045f, 0.04f, 0.06f),
                           Vector3f(0.012f, 0.016f, 0.035f), 0.0f);
    for (int k = 0; k < 5; ++k) {
      const float x = u - 0.65f + 0.29f * static_cast<float>(k);
      const float v = 1.45f + 0.14f * static_cast<float>((k * 3 + i) % 5);
      build.add_halo(x, v, 0.03f, 0.09f + 0.02f * static_cast<float>(k % 3),
                     (k + i) % 3 == 0 ? Vector3f(0.35f, 0.06f, 0.04f) : 0.35f * kLamp);
    }
    for (const float side : {-0.85f, -0.02f, 0.80f})
      build.add_box({u + side, u + side + 0.05f, 1.12f, 2.72f}, 0.0f, 0.05f, kWood);
    build.add_box({u - 0.85f, u + 0.85f, 2.70f, 2.76f}, 0.0f, 0.05f, kWood);
  }
}

void add_lamps(PlaceBuilder& build) {
  const float width = build.width_m(PlaceSide::kBack);
  const float length = build.width_m(PlaceSide::kLeft);
  for (const float share : {0.24f, 0.5f, 0.76f})
    build.add_lamp(PlaceSide::kBack, share * width, 1.9f, 1.1f, 1.1f * kLamp, 0.9f);
  for (const PlaceSide side : {PlaceSide::kLeft, PlaceSide::kRight})
    for (const float share : {0.15f, 0.5f, 0.85f})
      build.add_lamp(side, share * length, 2.75f, 0.4f, 0.9f * kLamp, 0.9f);
  for (const float share : {0.15f, 0.5f, 0.85f})
    build.add_lamp(PlaceSide::kFront, share * width, 2.9f, 0.4f, 0.6f * kLamp, 0.9f);
  // Spots over the floor.
  for (const float share : {0.35f, 0.65f})
    build.add_lamp(PlaceSide::kAbove, share * width, 0.5f * length, 0.3f, 0.5f * kLamp, 2.0f);
}

}  // namespace

PlaceShape make(const PlaceRoom& room) {
  PlaceBuilder build(Venue::kBar, room, kHeight_m);
  PlaceShape& shape = build.shape();
  shape.mood = {Vector3f(1.42f, 1.12f, 0.80f), Vector3f(0.30f, 0.26f, 0.28f),
                Vector3f(0.34f, 0.20f, 0.11f), Vector3f(0.75f, 0.50f, 0.30f)};
  shape.floor = {FloorPattern::kPlanks, Vector3f(0.21f, 0.105f, 0.052f),
                 Vector3f(0.125f, 0.058f, 0.028f), Vector3f(0.12f, 0.065f, 0.035f), 0.9f};
  shape.sky = {Vector3f(0.030f, 0.018f, 0.016f), Vector3f(0.016f, 0.011f, 0.013f),
               Vector3f(0.006f, 0.005f, 0.008f), Vector3f(0.014f, 0.010f, 0.011f)};
  add_lamps(build);
  build.begin(PlaceSide::kBack, kCounterDepth_m);
  add_wall(build, PlaceSide::kBack);
  add_counter(build);
  add_pendants(build);
  for (const PlaceSide side : {PlaceSide::kLeft, PlaceSide::kRight}) {
    build.begin(side, 1.05f);
    add_wall(build, side);
    add_tables(build, side);
    add_strings(build, side);
  }
  build.begin(PlaceSide::kFront, 0.4f);
  add_wall(build, PlaceSide::kFront);
  add_windows(build);
  add_strings(build, PlaceSide::kFront);
  build.begin(PlaceSide::kAbove, 0.1f);
  const float width = build.width_m(PlaceSide::kAbove);
  const float length = build.width_m(PlaceSide::kLeft);
  build.add_panel({0.0f, width, 0.0f, length}, 0.0f, 0.7f * kWall);
  build.add_floor();
  return build.take();
}

}  // namespace dance::bar_place
