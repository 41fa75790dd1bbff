// A piece of an avatar's surface while it is made: vertices with their joints, and triangles, or
// rows of vertices that become triangles.
//
// Units/frames: metres, W, T-pose with the middle of the floor below the hips at the origin.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "formats/avatar/avatar_model.h"

namespace dance {

constexpr float kTwoPi = 6.2831853f;
constexpr float kRadians = kTwoPi / 360.0f;  // of a degree
constexpr int kHeadJoint = static_cast<int>(index_of(Bone::kHead));
constexpr int kHipsJoint = static_cast<int>(index_of(Bone::kHips));

// 0 up to `from`, 1 from `to` on, smooth between.
inline float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

struct Sheet {
  std::vector<AvatarVertex> vertices;
  std::vector<std::uint32_t> triangles;
  // Of a morph's name: where each vertex is when it is at 1.
  std::map<std::string, std::vector<Eigen::Vector3f>> shapes;
};

// Of joint 0, facing up.
AvatarVertex vertex_at(const Eigen::Vector3f& place_m,
                       const Eigen::Vector2f& uv = Eigen::Vector2f::Zero());

// Weights of two joints: 1 − share of the first, share of the second.
void tie(AvatarVertex& vertex, int joint);
void tie(AvatarVertex& vertex, int first, int second, float share);

// Vertices of one joint, without triangles.
Sheet points_of(const std::vector<Eigen::Vector3f>& places_m, int joint);

enum class RowEnds : std::uint8_t { kOpen, kJoined };
// Triangles between rows of `columns` vertices each, from vertex `first` on. Seen from outside the
// rows go up (+Y) and the columns to the right.
void join_rows(Sheet& sheet, std::uint32_t first, std::uint32_t rows, std::uint32_t columns,
               RowEnds ends);
// Unit normals from the triangles, larger ones counting more; shared where places are.
void set_normals(Sheet& sheet);
void add_to(Sheet& sheet, const Sheet& more);

}  // namespace dance
