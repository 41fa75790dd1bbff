// PlotCanvas: a white sheet for lines and words, drawn off screen with the text and smooth lines of
// the overlay: for plots that are pictures.
//
// Units/frames: pixels from the top left; colours 0xRRGGBB as a screen shows them.
// Ownership:    owns its OpenGL context and ImGui's; one per process, and not beside an Overlay.
// Threads:      the one that made it.
// Failure:      create() names what is missing and the package that brings it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viewer/gl/picture.h"

namespace dance {

struct PlotPoint {
  double x = 0.0, y = 0.0;
};

class PlotCanvas {
 public:
  enum class Anchor { kLeft, kMiddle, kRight };
  enum class Size { kText, kTitle };

  static Result<std::unique_ptr<PlotCanvas>> create(int width_px, int height_px);
  virtual ~PlotCanvas() = default;

  virtual void line(PlotPoint from, PlotPoint to, std::uint32_t colour, double width) = 0;
  virtual void curve(const std::vector<PlotPoint>& points, std::uint32_t colour, double width) = 0;
  virtual void box(PlotPoint low, PlotPoint high, std::uint32_t colour) = 0;
  // `at` is the middle of the line's height.
  virtual void text(PlotPoint at, const std::string& words, std::uint32_t colour,
                    Anchor anchor = Anchor::kLeft, Size size = Size::kText) = 0;
  virtual double width_of(const std::string& words, Size size = Size::kText) const = 0;
  // What follows is drawn within the box only.
  virtual void clip(PlotPoint low, PlotPoint high) = 0;
  virtual void end_clip() = 0;

  // Once, when all is drawn.
  virtual Result<Picture> finish() = 0;

 protected:
  PlotCanvas() = default;
};

}  // namespace dance
