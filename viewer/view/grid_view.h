// GridView: many small stages: each dancer or couple in a cell of its own, with a camera that keeps
// them in the middle; for a teacher with a class.
//
// Units/frames: pixels from the top left; W for cameras.
// Ownership:    owns the cells' scenes; cells() borrow them until the next update().
// Threads:      none inside; the drawing thread owns it.
// Failure:      none.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewer/scene/stage_picture.h"
#include "viewer/view/camera_rig.h"
#include "viewer/view/couple_finder.h"

namespace dance {

// The places of n cells in a picture: as large as can be for people, who are taller than wide.
std::vector<PixelBox> grid_boxes(std::size_t n, int width_px, int height_px);

class GridView {
 public:
  GridView() = default;
  // A copy looks from where this one does, and makes cells of its own with its next update().
  GridView(const GridView& o)
      : couples_(o.couples_), turned_(o.turned_), raised_(o.raised_), zoomed_(o.zoomed_) {}
  GridView& operator=(const GridView&) = delete;

  // All cameras turn and zoom together.
  void drag_orbit(float right, float up);
  void zoom(float notches);
  void reset();

  void update(const SceneState& scene, const std::optional<GuestId>& chosen, int width_px,
              int height_px, Duration dt);
  std::span<const StageCell> cells() const { return cells_; }

 private:
  struct Cell {
    GuestId first;
    std::size_t people = 0;
    CameraRig rig;
    SceneState scene;
  };
  Cell& cell_of(const SceneGuest& first, std::size_t people);

  ViewCoupleFinder couples_;
  std::vector<std::unique_ptr<Cell>> kept_;
  std::vector<StageCell> cells_;
  float turned_ = 0.0f;
  float raised_ = 0.0f;
  float zoomed_ = 0.0f;
};

}  // namespace dance
