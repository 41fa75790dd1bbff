// FloorPainter: the floor and what lies on it: its light, the pulse of the beat, the dark spots
// under feet, and a ring of light where a guest is whose figure is still being made.
//
// Units/frames: W.
// Ownership:    owns its OpenGL objects; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() tells what the driver refuses.
#pragma once

#include <span>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/scene/scene.h"
#include "viewer/stage/contact_spots.h"
#include "viewer/stage/stage_light.h"
#include "viewer/stage/stage_look.h"

namespace dance {

// Where the guests are.
struct StageArea {
  Eigen::Vector3f centre_W_m;
  float radius_m;
};

// Radius of the pool of light round an area.
float pool_of(const StageArea& area);
// Radius of the area whose floor has faded out at that distance from its centre.
float radius_of_floor_that_ends_at(float ends_m);

// Of the ring that runs outwards with each beat.
struct BeatPulse {
  float radius_m = 0.0f;
  float ring = 0.0f;  // strengths, 0..1
  float glow = 0.0f;
};
// Strongest on the beat, and more so on a bar's one.
BeatPulse pulse_of(const SceneMusic& music);

struct WaitingGuest {
  Eigen::Vector3f place_W_m;
  Eigen::Vector3f colour;
  float opacity = 1.0f;
};

class FloorPainter {
 public:
  static Result<FloorPainter> create(Quality quality);

  void draw_floor(const StageLight& light, const Eigen::Matrix4f& clip_from_world,
                  const Eigen::Vector3f& eye_W_m, const StageArea& area, const BeatPulse& pulse);
  void draw_spots(const Eigen::Matrix4f& clip_from_world, std::span<const ContactSpot> spots);
  void draw_waiting(const Eigen::Matrix4f& clip_from_world, std::span<const WaitingGuest> guests);

 private:
  explicit FloorPainter(Quality quality);
  void upload(std::span<const ContactSpot> spots);

  Quality quality_;
  GlProgram floor_;
  GlProgram spot_;
  GlProgram waiting_;
  GlVertexArray no_vertices_;
  GlVertexArray spot_array_;
  GlBuffer spot_buffer_;
  std::vector<ContactSpot> rings_;
};

}  // namespace dance
