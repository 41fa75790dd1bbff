#include "viewer/view/grid_view.h"

#include <algorithm>

namespace dance {
namespace {
constexpr float kWidthOfHeight = 0.8f;  // what a dancing body wants
constexpr int kGap_px = 2;
constexpr int kSmallest_px = 16;
}  // namespace

std::vector<PixelBox> grid_boxes(std::size_t n, int width_px, int height_px) {
  std::vector<PixelBox> boxes;
  if (n == 0) return boxes;
  const auto count = static_cast<int>(n);
  int columns = 1;
  float best = -1.0f;
  for (int c = 1; c <= count; ++c) {
    const int rows = (count + c - 1) / c;
    // The height of a body in such a cell.
    const float room =
        std::min(static_cast<float>(height_px) / static_cast<float>(rows),
                 static_cast<float>(width_px) / static_cast<float>(c) / kWidthOfHeight);
    if (room <= best) continue;
    best = room;
    columns = c;
  }
  const int rows = (count + columns - 1) / columns;
  const int width = std::max(kSmallest_px, (width_px - kGap_px * (columns - 1)) / columns);
  const int height = std::max(kSmallest_px, (height_px - kGap_px * (rows - 1)) / rows);
  for (int i = 0; i < count; ++i) {
    const int row = i / columns;
    const int in_row = row == rows - 1 ? count - columns * (rows - 1) : columns;
    // A last row with fewer stands in the middle.
    const int indent = (width_px - in_row * width - (in_row - 1) * kGap_px) / 2;
    boxes.push_back(
        {indent + (i % columns) * (width + kGap_px), row * (height + kGap_px), width, height});
  }
  return boxes;
}

GridView::Cell& GridView::cell_of(const SceneGuest& first, std::size_t people) {
  for (const auto& cell : kept_)
    if (cell->first == first.id && cell->people == people) return *cell;
  kept_.push_back(
      std::make_unique<Cell>(Cell{first.id, people, CameraRig(CameraPreset::kAuto), {}}));
  Cell& made = *kept_.back();
  made.rig.drag_orbit(turned_, raised_);
  made.rig.zoom(zoomed_);
  if (turned_ == 0.0f && raised_ == 0.0f) made.rig = CameraRig(CameraPreset::kAuto);
  return made;
}

void GridView::drag_orbit(float right, float up) {
  turned_ += right;
  raised_ += up;
  for (const auto& cell : kept_) cell->rig.drag_orbit(right, up);
}

void GridView::zoom(float notches) {
  zoomed_ += notches;
  for (const auto& cell : kept_) cell->rig.zoom(notches);
}

void GridView::reset() {
  kept_.clear();
  cells_.clear();
  turned_ = raised_ = zoomed_ = 0.0f;
}

void GridView::update(const SceneState& scene, const std::optional<GuestId>& chosen, int width_px,
                      int height_px, Duration dt) {
  cells_.clear();
  const auto& groups = couples_.groups(scene);
  const std::vector<PixelBox> boxes = grid_boxes(groups.size(), width_px, height_px);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Cell& cell = cell_of(scene.guests[groups[g].front()], groups[g].size());
    cell.scene.time = scene.time;
    cell.scene.stage = static_cast<int>(g) + 1;
    cell.scene.music = scene.music;
    cell.scene.shows_trails = scene.shows_trails;
    cell.scene.guests.clear();
    bool is_chosen = false;
    for (const std::size_t i : groups[g]) {
      cell.scene.guests.push_back(scene.guests[i]);
      is_chosen = is_chosen || (chosen && scene.guests[i].id == *chosen);
    }
    cell.rig.update(cell.scene, boxes[g].aspect(), dt);
    cells_.push_back(
        {&cell.scene, cell.rig.camera(), boxes[g], cell.rig.stage_yaw_rad(), is_chosen});
  }
  std::erase_if(kept_, [&](const std::unique_ptr<Cell>& cell) {
    return std::none_of(cells_.begin(), cells_.end(),
                        [&](const StageCell& shown) { return shown.scene == &cell->scene; });
  });
}

}  // namespace dance
