// PictureTarget: the memory that a picture is drawn in: multisampled linear light, the same
// resolved, and the finished 8-bit picture, which a window shows and a file keeps. As both take the
// same one, both have the same pixels.
//
// Units/frames: pixels; rows from the bottom, as OpenGL has them.
// Ownership:    owns its OpenGL objects.
// Threads:      the one whose context is current.
// Failure:      resize() tells what the driver refuses.
#pragma once

#include "viewer/gl/gl_objects.h"

namespace dance {

class PictureTarget {
 public:
  explicit PictureTarget(int samples) : samples_(samples) {}

  Result<void> resize(int width_px, int height_px);
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  void bind_light() const;     // draw the stage here
  void resolve_light() const;  // then this
  const GlTexture& light() const { return light_texture_; }
  void bind_finished() const;  // then the finished picture here
  const GlFramebuffer& finished() const { return finished_; }

 private:
  void make_light(int width_px, int height_px);

  int samples_;
  int width_px_ = 0;
  int height_px_ = 0;
  GlRenderbuffer light_samples_;
  GlRenderbuffer depth_;
  GlFramebuffer light_;
  GlTexture light_texture_;
  GlFramebuffer resolved_;
  GlTexture finished_texture_;
  GlFramebuffer finished_;
};

}  // namespace dance
