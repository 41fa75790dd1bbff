#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "viewer/stage/place/place_builder.h"
#include "viewer/stage/place/places.h"

namespace dance::terrace_place {

using Eigen::Vector3f;

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const Vector3f kStone(0.40f, 0.36f, 0.33f);
const Vector3f kLamp(1.0f, 0.66f, 0.34f);
const Vector3f kBulb(2.4f, 1.55f, 0.75f);
constexpr float kDepth_m = 0.75f;
constexpr float kPole_m = 3.0f;

// Repeatable pseudo-random numbers in 0..1.
float noise(int i, int salt) {
  auto x = static_cast<std::uint32_t>(i) * 2654435761u + static_cast<std::uint32_t>(salt) * 97u;
  x = (x ^ (x >> 15)) * 2246822519u;
  x = (x ^ (x >> 13)) * 3266489917u;
  return static_cast<float>((x ^ (x >> 16)) & 0xffffu) / 65535.0f;
}

int spans_of(const PlaceBuilder& build, PlaceSide side) {
  return std::max(2, static_cast<int>(build.width_m(side) / 3.0f));
}

void add_balusters(PlaceBuilder& build, float from, float to) {
  const int count = std::max(1, static_cast<int>((to - from) / 0.32f));
  for (int i = 0; i < count; ++i) {
    const float u = from + (to - from) * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    build.add_box({u - 0.045f, u + 0.045f, 0.16f, 0.48f}, 0.12f, 0.21f, kStone);
    build.add_box({u - 0.028f, u + 0.028f, 0.48f, 0.86f}, 0.137f, 0.193f, kStone);
  }
}

void add_lantern(PlaceBuilder& build, float u) {
  const Vector3f iron = Vector3f::Constant(0.03f);
  build.add_box({u - 0.12f, u + 0.12f, 1.14f, 1.17f}, 0.045f, 0.285f, iron);
  build.add_bright_box({u - 0.085f, u + 0.085f, 1.17f, 1.43f}, 0.08f, 0.25f, 1.5f * kLamp, 1.0f);
  build.add_box({u - 0.12f, u + 0.12f, 1.43f, 1.47f}, 0.045f, 0.285f, iron);
  build.add_box({u - 0.05f, u + 0.05f, 1.47f, 1.53f}, 0.115f, 0.215f, iron);
  build.add_halo(u, 1.3f, 0.17f, 0.75f, 0.55f * kLamp);
}

// Pillars with lanterns, balusters between them, and a string of bulbs from pole to pole.
void add_side(PlaceBuilder& build, PlaceSide side) {
  const float width = build.width_m(side);
  const int spans = spans_of(build, side);
  build.begin(side, kDepth_m);
  build.add_box({0.0f, width, 0.0f, 0.16f}, 0.06f, 0.27f, kStone);
  build.add_box({0.0f, width, 0.86f, 0.98f}, 0.05f, 0.29f, 1.1f * kStone);
  for (int i = 0; i <= spans; ++i) {
    const float u = width * static_cast<float>(i) / static_cast<float>(spans);
    build.add_box({u - 0.19f, u + 0.19f, 0.0f, 1.05f}, 0.0f, 0.36f, kStone);
    build.add_box({u - 0.23f, u + 0.23f, 1.05f, 1.14f}, 0.0f, 0.40f, 1.1f * kStone);
    // The lantern of the last pillar belongs to the next side, which shares that corner.
    if (i < spans) add_lantern(build, u + (i == 0 ? 0.17f : 0.0f));
    if (i == spans) break;
    const float next = width * static_cast<float>(i + 1) / static_cast<float>(spans);
    add_balusters(build, u + 0.2f, next - 0.2f);
  }
  // The pole at the other corner belongs to the next side.
  build.add_box({0.175f, 0.225f, 1.1f, kPole_m}, 0.175f, 0.225f, Vector3f::Constant(0.04f));
  const int strings = std::max(2, spans / 2);
  for (int i = 0; i < strings; ++i)
    build.add_string_of_bulbs(
        Vector3f(width * static_cast<float>(i) / static_cast<float>(strings), kPole_m, 0.2f),
        Vector3f(width * static_cast<float>(i + 1) / static_cast<float>(strings), kPole_m, 0.2f),
        0.4f, 9, kBulb);
}

// A ridge all around. Its lower edge is below the horizon.
void add_hills(PlaceBuilder& build, float radius_m, float low_m, float high_m, int salt,
               const Vector3f& ridge, const Vector3f& foot) {
  constexpr int kSteps = 72;
  const auto height = [&](int i) {
    const float a = 2.0f * kPi * static_cast<float>(i % kSteps) / kSteps;
    const auto s = static_cast<float>(salt);
    const float wave = 0.5f + 0.26f * std::sin(3.0f * a + s) +
                       0.16f * std::sin(7.0f * a + 2.0f * s) +
                       0.08f * std::sin(16.0f * a + 3.0f * s);
    return low_m + (high_m - low_m) * wave;
  };
  const auto at = [&](int i, float y) {
    const float a = 2.0f * kPi * static_cast<float>(i) / kSteps;
    return Vector3f(radius_m * std::sin(a), y, -radius_m * std::cos(a));
  };
  constexpr float kFoot_m = -90.0f;
  for (int i = 0; i < kSteps; ++i)
    build.add_quad({at(i, kFoot_m), at(i + 1, kFoot_m), at(i + 1, height(i + 1)), at(i, height(i))},
                   {foot, foot, ridge, ridge}, 0.0f);
}

// A small quad that faces the terrace.
void add_point(PlaceBuilder& build, const Vector3f& p, float half_m, const Vector3f& colour) {
  const Vector3f to_middle = -p.normalized();
  Vector3f right = Vector3f::UnitY().cross(to_middle);
  if (right.squaredNorm() < 1e-4f) right = Vector3f::UnitX();
  right = half_m * right.normalized();
  const Vector3f up = half_m * to_middle.cross(right).normalized();
  build.add_quad({p - right - up, p + right - up, p + right + up, p - right + up},
                 {colour, colour, colour, colour}, 0.0f);
}

void add_town(PlaceBuilder& build) {
  constexpr int kLights = 220;
  for (int i = 0; i < kLights; ++i) {
    // More of them in the valley, towards the back and the left.
    const float spread = noise(i, 1) + noise(i, 2) + noise(i, 3) - 1.5f;
    const float a = -0.5f + 1.9f * spread;
    const float r = 205.0f - 55.0f * noise(i, 4);
    const float y = -4.0f - 26.0f * noise(i, 5) * noise(i, 6);
    const Vector3f colour =
        noise(i, 7) < 0.75f ? Vector3f(1.0f, 0.62f, 0.26f) : Vector3f(0.75f, 0.80f, 0.95f);
    add_point(build, {r * std::sin(a), y, -r * std::cos(a)}, 0.22f + 0.22f * noise(i, 8),
              (0.45f + 0.7f * noise(i, 9)) * colour);
  }
}

void add_stars(PlaceBuilder& build) {
  constexpr int kStars = 130;
  for (int i = 0; i < kStars; ++i) {
    const float a = 2.0f * kPi * noise(i, 21);
    const float up = 0.28f + 0.7f * noise(i, 22);
    const float level = std::sqrt(std::max(0.0f, 1.0f - up * up));
    add_point(build, 330.0f * Vector3f(level * std::sin(a), up, level * std::cos(a)),
              0.28f + 0.2f * noise(i, 23),
              (0.15f + 0.5f * noise(i, 24)) * Vector3f(0.9f, 0.92f, 1.0f));
  }
}

}  // namespace

PlaceShape make(const PlaceRoom& room) {
  PlaceBuilder build(Venue::kTerrace, room, 0.0f);
  PlaceShape& shape = build.shape();
  shape.mood = {Vector3f(1.40f, 1.16f, 0.90f), Vector3f(0.34f, 0.38f, 0.56f),
                Vector3f(0.26f, 0.21f, 0.19f), Vector3f(0.70f, 0.58f, 0.62f)};
  shape.floor = {FloorPattern::kTiles, Vector3f(0.30f, 0.255f, 0.215f),
                 Vector3f(0.225f, 0.185f, 0.155f), Vector3f(0.13f, 0.11f, 0.15f), 0.35f};
  shape.sky = {Vector3f(0.40f, 0.175f, 0.085f), Vector3f(0.115f, 0.085f, 0.150f),
               Vector3f(0.014f, 0.022f, 0.060f), Vector3f(0.010f, 0.010f, 0.016f)};
  constexpr std::array kSides{PlaceSide::kBack, PlaceSide::kFront, PlaceSide::kLeft,
                              PlaceSide::kRight};
  for (const PlaceSide side : kSides) {
    const int spans = spans_of(build, side);
    for (int i = 0; i < spans; ++i)
      build.add_lamp(side, build.width_m(side) * static_cast<float>(i) / static_cast<float>(spans),
                     1.4f, 0.5f, 0.75f * kLamp, 0.9f);
  }
  build.begin(PlaceSide::kFar);
  add_stars(build);
  add_hills(build, 300.0f, 2.0f, 38.0f, 3, Vector3f(0.085f, 0.060f, 0.085f),
            Vector3f(0.030f, 0.026f, 0.040f));
  add_hills(build, 215.0f, -8.0f, 11.0f, 8, Vector3f(0.026f, 0.024f, 0.036f),
            Vector3f(0.010f, 0.010f, 0.016f));
  add_town(build);
  for (const PlaceSide side : kSides) add_side(build, side);
  build.add_floor();
  return build.take();
}

}  // namespace dance::terrace_place
