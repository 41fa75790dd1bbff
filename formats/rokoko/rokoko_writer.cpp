#include "formats/rokoko/rokoko_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace dance {
namespace {

constexpr std::string_view kEnd = R"(],"characters":[],"props":[]}})";

}  // namespace

void RokokoWriter::add_number(double value) {
  constexpr double kLargest = 1e9;  // of what stands in a frame; bounds the digits
  std::array<char, 32> digits;
  const double bounded = std::isfinite(value) ? std::clamp(value, -kLargest, kLargest) : 0.0;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), bounded,
                                 std::chars_format::fixed, 6);
  add({digits.data(), end.ptr});
}

// Names of ours need no escapes; of others what would is left out.
void RokokoWriter::add_name(std::string_view name) {
  for (const char c : name)
    if (static_cast<unsigned char>(c) >= 0x20 && c != '"' && c != '\\') text_.push_back(c);
}

void RokokoWriter::add_flag(std::string_view key, bool value) {
  add(key);
  add(value ? "true" : "false");
}

void RokokoWriter::add_joint(std::string_view name, const RokokoJoint& joint) {
  add("\"");
  add(name);
  add(R"(":{"position":{"x":)");
  add_number(joint.position.x());
  add(R"(,"y":)");
  add_number(joint.position.y());
  add(R"(,"z":)");
  add_number(joint.position.z());
  add(R"(},"rotation":{"x":)");
  add_number(joint.rotation.x());
  add(R"(,"y":)");
  add_number(joint.rotation.y());
  add(R"(,"z":)");
  add_number(joint.rotation.z());
  add(R"(,"w":)");
  add_number(joint.rotation.w());
  add("}}");
}

void RokokoWriter::add_actor(const RokokoActor& actor) {
  add(R"({"name":")");
  add_name(actor.name.view());
  add(R"(","color":[)");
  for (std::size_t i = 0; i < actor.color.size(); ++i) {
    if (i > 0) add(",");
    std::array<char, 4> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), actor.color[i]);
    add({digits.data(), end.ptr});
  }
  add_flag(R"(],"meta":{"hasGloves":)", actor.has_left_glove || actor.has_right_glove);
  add_flag(R"(,"hasLeftGlove":)", actor.has_left_glove);
  add_flag(R"(,"hasRightGlove":)", actor.has_right_glove);
  add_flag(R"(,"hasBody":)", actor.has_body);
  add(R"(,"hasFace":false},"dimensions":{"totalHeight":)");
  add_number(actor.total_height_m);
  add(R"(,"hipHeight":)");
  add_number(actor.hip_height_m);
  add(R"(},"body":{)");
  bool is_first = true;
  for (std::size_t j = 0; j < kRokokoJointCount; ++j) {
    if (!actor.present[j]) continue;
    if (!is_first) add(",");
    is_first = false;
    add_joint(rokoko_joint_name(j), actor.joints[j]);
  }
  add("}}");
}

RokokoWriter::Written RokokoWriter::write(const RokokoFrame& frame, std::size_t most_actors,
                                          std::size_t most_bytes) {
  text_.clear();
  add(R"({"version":"3,0","fps":)");
  add_number(frame.fps);
  add(R"(,"scene":{"timestamp":)");
  add_number(frame.timestamp_s);
  add(R"(,"actors":[)");
  std::size_t written = 0;
  for (const RokokoActor& actor : frame.actors) {
    if (written == most_actors) break;
    const std::size_t before = text_.size();
    if (written > 0) add(",");
    add_actor(actor);
    if (text_.size() + kEnd.size() > most_bytes) {
      text_.resize(before);
      break;
    }
    ++written;
  }
  add(kEnd);
  return {{text_.data(), text_.size()}, written};
}

}  // namespace dance
