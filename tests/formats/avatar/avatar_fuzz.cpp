// libFuzzer target: any bytes through the avatar reader; the model is sound, and all its texts are
// plain: valid UTF-8 that can be shown.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "core/base/text/plain_text.h"
#include "formats/avatar/avatar_reader.h"
#include "tests/fuzz_target.h"

namespace {

void expect_plain(const std::string& text) { DANCE_ASSERT(dance::plain_text(text) == text); }

}  // namespace

DANCE_FUZZ_TARGET(avatar) {
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
    expect_plain(read.error().what);
    return 0;
  }
  const dance::AvatarModel& model = read->model;
  DANCE_ASSERT(dance::is_sound(model));
  DANCE_ASSERT(!model.parts.empty() && model.joints.size() <= limits.joints);
  DANCE_ASSERT(model.vertices.size() <= limits.vertices);
  for (const std::string& note : read->notes) expect_plain(note);
  expect_plain(model.name);
  expect_plain(model.licence);
  for (const auto& node : model.nodes) expect_plain(node.name);
  for (const auto& material : model.materials) expect_plain(material.name);
  for (const auto& morph : model.morphs) expect_plain(morph.name);
  for (const auto& expression : model.expressions) expect_plain(expression.name);
  return 0;
}
