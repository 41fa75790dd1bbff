// The mesh that the vertex shader bends into every body part: rings of two half balls, given as
// angles only, so that one mesh serves all radii and lengths.
//
// Units/frames: longitude counts from the part's side axis towards its third axis; triangles are
//               counter-clockwise from outside.
// Ownership:    owns its OpenGL buffers.
// Threads:      the one whose context is current.
// Failure:      none.
#pragma once

#include <cstdint>
#include <vector>

#include "viewer/gl/gl_objects.h"

namespace dance {

struct CapsuleVertex {
  float cos_longitude;
  float sin_longitude;
  float arc;  // 0..1 along the arc that its end covers, from a towards b
  float end;  // 0 = the ball at a, 1 = the ball at b
};

struct CapsuleShape {
  std::vector<CapsuleVertex> vertices;
  std::vector<std::uint16_t> indices;
};

CapsuleShape make_capsule_shape(int segments, int rings_per_end);

// A capsule mesh on the graphics card, with room for instances of BodyPart beside it.
class CapsuleMesh {
 public:
  CapsuleMesh(int segments, int rings_per_end);

  // Uploads the parts; draw() draws them all in one call.
  void upload(const void* parts, std::size_t count);
  void draw() const;

 private:
  GlVertexArray array_;
  GlBuffer vertices_;
  GlBuffer indices_;
  GlBuffer parts_;
  GLsizei index_count_ = 0;
  GLsizei part_count_ = 0;
};

}  // namespace dance
