#include "viewer/stage/capsule_mesh.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/assert.h"
#include "viewer/stage/body_part.h"

namespace dance {

CapsuleShape make_capsule_shape(int segments, int rings_per_end) {
  DANCE_ASSERT(segments >= 3 && rings_per_end >= 2, segments, rings_per_end);
  CapsuleShape shape;
  for (int end = 0; end < 2; ++end) {
    for (int ring = 0; ring <= rings_per_end; ++ring) {
      for (int segment = 0; segment <= segments; ++segment) {
        const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(segment) /
                            static_cast<float>(segments);
        shape.vertices.push_back({std::cos(angle), std::sin(angle),
                                  static_cast<float>(ring) / static_cast<float>(rings_per_end),
                                  static_cast<float>(end)});
      }
    }
  }
  DANCE_ASSERT(shape.vertices.size() <= std::numeric_limits<std::uint16_t>::max());
  const int ring_count = 2 * (rings_per_end + 1);
  const int stride = segments + 1;
  for (int ring = 0; ring + 1 < ring_count; ++ring) {
    for (int segment = 0; segment < segments; ++segment) {
      // Seen from outside, longitude grows to the left and rings grow upwards.
      const auto right_low = static_cast<std::uint16_t>(ring * stride + segment);
      const auto left_low = static_cast<std::uint16_t>(right_low + 1);
      const auto right_high = static_cast<std::uint16_t>(right_low + stride);
      const auto left_high = static_cast<std::uint16_t>(right_high + 1);
      shape.indices.insert(shape.indices.end(),
                           {right_low, right_high, left_high, right_low, left_high, left_low});
    }
  }
  return shape;
}

CapsuleMesh::CapsuleMesh(int segments, int rings_per_end)
    : array_(GlVertexArray::make()),
      vertices_(GlBuffer::make()),
      indices_(GlBuffer::make()),
      parts_(GlBuffer::make()) {
  const CapsuleShape shape = make_capsule_shape(segments, rings_per_end);
  index_count_ = static_cast<GLsizei>(shape.indices.size());
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(shape.vertices.size() * sizeof(CapsuleVertex)),
               shape.vertices.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(CapsuleVertex), nullptr);
  glEnableVertexAttribArray(0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(shape.indices.size() * sizeof(std::uint16_t)),
               shape.indices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, parts_.name());
  for (GLuint i = 0; i < sizeof(BodyPart) / 16; ++i) {
    glVertexAttribPointer(1 + i, 4, GL_FLOAT, GL_FALSE, sizeof(BodyPart),
                          reinterpret_cast<const void*>(static_cast<std::uintptr_t>(16 * i)));
    glEnableVertexAttribArray(1 + i);
    glVertexAttribDivisor(1 + i, 1);
  }
  glBindVertexArray(0);
  check_gl("CapsuleMesh");
}

void CapsuleMesh::upload(const void* parts, std::size_t count) {
  part_count_ = static_cast<GLsizei>(count);
  glBindBuffer(GL_ARRAY_BUFFER, parts_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * sizeof(BodyPart)), parts,
               GL_STREAM_DRAW);
}

void CapsuleMesh::draw() const {
  if (part_count_ == 0) return;
  glBindVertexArray(array_.name());
  glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_SHORT, nullptr, part_count_);
}

}  // namespace dance
