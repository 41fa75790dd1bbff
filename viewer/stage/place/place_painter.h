// PlacePainter: draws a place: its walls and lamps, its floor, the sky, and the masks inside which
// mirror images are drawn.
//
// Units/frames: W.
// Ownership:    owns its OpenGL objects; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() returns the driver's error.
#pragma once

#include "viewer/gl/gl_objects.h"
#include "viewer/scene/camera.h"
#include "viewer/stage/floor_painter.h"
#include "viewer/stage/place/place_shape.h"

namespace dance {

// Relative change of the lamps' brightness: one cycle a bar, brightest on the first beat; 0 if the
// music's bars are unknown.
float lamp_breath(const std::optional<SceneMusic>& music);

// The mirrored eye: it sees things where the real eye sees their mirror images.
StageEye eye_in_floor(const StageEye& eye);
StageEye eye_in_mirror(const StageEye& eye, const PlaceMirror& mirror);

class PlacePainter {
 public:
  static Result<PlacePainter> create(Quality quality);

  // Selects the place of the next pictures. A change of place or room makes the geometry again.
  void show(Venue place, const PlaceRoom& room);
  void set_breath(float breath) { breath_ = breath; }
  const PlaceShape& shape() const { return shape_; }
  // The mirror, if that eye is in front of it.
  std::optional<PlaceMirror> mirror_for(const StageEye& eye) const;

  // Until end_mask() drawing is limited to the mirror and the floor, as selected.
  void begin_mask(const StageEye& eye, bool floor, bool mirror) const;
  void end_mask() const;

  // Opaque groups; the glass over a mirror image; fading groups and the lamps' halos, which come
  // after the rest of the place.
  void draw_solid(const StageEye& eye) const;
  void draw_glass(const StageEye& eye) const;
  void draw_fading(const StageEye& eye) const;
  // Draws the opaque groups for a mirrored eye, without the mirror's own wall.
  void draw_image(const StageEye& image, bool has_floor) const;

  // The floor of the room, and the floor beyond walls that are not drawn.
  void draw_floor(const StageLight& light, const StageEye& eye, const StageArea& area,
                  const BeatPulse& pulse) const;
  void draw_beyond(const StageLight& light, const StageEye& eye, const StageArea& area) const;
  // Fills the pixels that nothing else covers.
  void draw_sky(const StageEye& eye) const;

 private:
  explicit PlacePainter(Quality quality);
  void begin_walls(const StageEye& eye, float alpha) const;
  void draw(const PlaceGroup& group) const;
  void draw_halos(const StageEye& eye, const PlaceGroup& group, float strength) const;
  const GlProgram& begin_floor(const StageLight& light, const StageEye& eye,
                               const StageArea& area) const;

  Quality quality_;
  PlaceShape shape_;
  float breath_ = 0.0f;
  GlProgram walls_;
  GlProgram halo_;
  GlProgram planks_;
  GlProgram tiles_;
  GlProgram sky_;
  GlVertexArray no_vertices_;
  GlVertexArray array_;
  GlBuffer buffer_;
  GlBuffer corners_;  // indices: two triangles for each quad
  GlVertexArray halo_array_;
  GlBuffer halo_buffer_;
};

}  // namespace dance
