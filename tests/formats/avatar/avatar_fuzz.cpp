// libFuzzer target: any bytes through the avatar reader; what it makes of them is sound, and all
// that it says is printable.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "formats/avatar/avatar_reader.h"

namespace {

void expect_printable(const std::string& text) {
  for (const char c : text) DANCE_ASSERT(c >= 0x20 && c < 0x7f, c);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dance::AvatarLimits limits;
  limits.json_objects = 4096;
  limits.nodes = 256;
  limits.joints = 128;
  limits.vertices = 5000;
  limits.triangles = 5000;
  limits.picture_side_px = 256;
  limits.reduced_side_px = 64;
  limits.decoded_bytes = 1u << 20;
  limits.numbers = 1u << 18;
  limits.bytes = 1u << 22;
  const auto read = dance::read_avatar(std::span(data, size), limits, "fuzz");
  if (!read) {
    DANCE_ASSERT(!read.error().what.empty());
    expect_printable(read.error().what);
    return 0;
  }
  const dance::AvatarModel& model = read->model;
  DANCE_ASSERT(dance::is_sound(model));
  DANCE_ASSERT(!model.parts.empty() && model.joints.size() <= limits.joints);
  DANCE_ASSERT(model.vertices.size() <= limits.vertices);
  for (const std::string& note : read->notes) expect_printable(note);
  expect_printable(model.name);
  expect_printable(model.licence);
  for (const auto& node : model.nodes) expect_printable(node.name);
  for (const auto& material : model.materials) expect_printable(material.name);
  for (const auto& morph : model.morphs) expect_printable(morph.name);
  for (const auto& expression : model.expressions) expect_printable(expression.name);
  return 0;
}
