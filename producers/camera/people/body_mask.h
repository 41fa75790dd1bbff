// BodyMask: takes the bodies of others out of what a network sees of a region, so that it finds the
// wished one, and not one of them or parts of both.
//
// Units/frames: pixels of the picture; the region as sample_region() fills it, `side_px` rows and
//               columns of red, green and blue.
// Ownership:    about 64 KB of its own; writes the caller's numbers; no heap.
// Threads:      none inside.
// Failure:      none; what is outside of the region is left.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "producers/camera/estimator/landmark_network.h"

namespace dance {

class BodyMask {
 public:
  static constexpr int kMostSide_px = LandmarkNetwork::kSide_px;

  // Nobody is in it yet.
  void begin(const BodyRegion& region, int side_px = kMostSide_px);
  void add(const SeenBody& body);
  // Takes this body, and a little around it, out of the mask; nor is it painted over others.
  void spare(const SeenBody& body);
  // A grey figure would still be a figure: each row goes over from what is on the left of the mask
  // to what is on its right.
  void paint_over(std::span<float> red_green_blue) const;
  // Whether a place of the picture is behind somebody.
  bool covers(const Eigen::Vector2f& place_px) const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_px_) +
           static_cast<std::size_t>(x);
  }
  Eigen::Vector2f place(const Eigen::Vector2f& place_px) const;
  enum class Cell : std::uint8_t { kFree, kMasked, kSpared };
  bool is_masked(int x, int y) const { return cells_[index(x, y)] == Cell::kMasked; }
  // All bars of a body, each by so much thicker.
  void set(const SeenBody& body, float thicker, Cell cell);
  void fill(const Eigen::Vector2f& a, const Eigen::Vector2f& b, float radius, Cell cell);
  // The mean of the nearest free pixels of a row, from `x` on to the left (-1) or right (1).
  std::optional<Eigen::Vector3f> mean(std::span<const float> pixels, int x, int step, int y) const;
  void paint_run(std::span<float> pixels, int from, int to, int y) const;

  RegionFrame frame_{BodyRegion()};
  int side_px_ = kMostSide_px;
  float scale_ = 1.0f;
  bool is_empty_ = true;
  std::array<Cell, static_cast<std::size_t>(kMostSide_px) * kMostSide_px> cells_{};
};

}  // namespace dance
