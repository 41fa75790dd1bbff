// Axes: between the axes of a house (glTF's) and those of an engine, both ways, in one place. Each
// engine's axes are ours, permuted and mirrored, and its unit a multiple of the metre.
//
// Units/frames: p' = scale · M · p with M a signed permutation; a rotation q = (v, w) becomes
//               (det M · M · v, w), which turns M · p as q turns p, mirrored axes too. As v ↦ M · v
//               keeps lengths, unit rotations stay unit.
// Ownership:    plain values.
// Threads:      constants only.
// Failure:      find_axes() returns nullptr for a number that is no dance_axes.
// Source:       glTF 2.0 section 3.4; Unity manual, rotation and orientation; Unreal Engine
//               documentation, coordinate system and spaces; Blender manual, coordinate system.
#pragma once

#include <cstddef>
#include <cstring>

namespace dance::engine {

struct Axes {
  // Row i of M: sign[i] at column from[i]. Its inverse likewise, as M⁻¹ = Mᵀ.
  struct Turned {
    std::size_t from[3];
    float sign[3];
  };
  Turned out;  // ours to the engine's
  Turned in;   // the engine's to ours
  float determinant;
  float scale;  // of the engine's unit in a metre

  void point_out(const float* ours, float* theirs) const { point(out, scale, ours, theirs); }
  void point_in(const float* theirs, float* ours) const { point(in, 1.0f / scale, theirs, ours); }
  // `count` rotations, one after the other.
  void rotations_out(const float* ours_xyzw, float* theirs_xyzw, std::size_t count) const {
    rotations(out, ours_xyzw, theirs_xyzw, count);
  }
  void rotations_in(const float* theirs_xyzw, float* ours_xyzw, std::size_t count) const {
    rotations(in, theirs_xyzw, ours_xyzw, count);
  }

 private:
  static void point(const Turned& m, float scale, const float* p, float* turned) {
    for (std::size_t i = 0; i < 3; ++i) turned[i] = scale * m.sign[i] * p[m.from[i]];
  }
  void rotations(const Turned& m, const float* q, float* turned, std::size_t count) const {
    const float sign[3] = {determinant * m.sign[0], determinant * m.sign[1],
                           determinant * m.sign[2]};
    const bool is_same = m.from[0] == 0 && m.from[1] == 1 && m.from[2] == 2 && sign[0] > 0.0f &&
                         sign[1] > 0.0f && sign[2] > 0.0f;
    if (is_same) {
      std::memcpy(turned, q, count * 4 * sizeof *q);
      return;
    }
    for (std::size_t r = 0; r < count; ++r, q += 4, turned += 4) {
      for (std::size_t i = 0; i < 3; ++i) turned[i] = sign[i] * q[m.from[i]];
      turned[3] = q[3];
    }
  }
};

// By number of dance_axes.
inline const Axes* find_axes(int number) {
  static constexpr Axes kAxes[] = {
      // glTF, VRM 1, OpenXR, Godot.
      {{{0, 1, 2}, {1, 1, 1}}, {{0, 1, 2}, {1, 1, 1}}, 1.0f, 1.0f},
      // Unity: (-x, y, z), which is its own inverse.
      {{{0, 1, 2}, {-1, 1, 1}}, {{0, 1, 2}, {-1, 1, 1}}, -1.0f, 1.0f},
      // Unreal: (z, -x, y) in cm.
      {{{2, 0, 1}, {1, -1, 1}}, {{1, 2, 0}, {-1, 1, 1}}, -1.0f, 100.0f},
      // Blender: (x, -z, y).
      {{{0, 2, 1}, {1, -1, 1}}, {{0, 2, 1}, {1, 1, -1}}, 1.0f, 1.0f},
  };
  constexpr int kCount = static_cast<int>(sizeof kAxes / sizeof kAxes[0]);
  return number >= 0 && number < kCount ? &kAxes[number] : nullptr;
}

}  // namespace dance::engine
