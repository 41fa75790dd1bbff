#include "tests/formats/bvh/built_figure.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace dance::test {
namespace {

using Eigen::Vector3d;

std::string numbers(const Vector3d& v) {
  return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
}

std::string json_array(const Vector3d& v) {
  return "[" + std::to_string(v.x()) + "," + std::to_string(v.y()) + "," + std::to_string(v.z()) +
         "]";
}

void append_u32(std::string& out, std::uint32_t value) {
  char bytes[4];
  std::memcpy(bytes, &value, 4);
  out.append(bytes, 4);
}

void append_float(std::string& out, double value) {
  const auto single = static_cast<float>(value);
  char bytes[4];
  std::memcpy(bytes, &single, 4);
  out.append(bytes, 4);
}

void add_fingers(const RigWords& words, bool left, BuiltFigure& figure) {
  const double side = left ? 1.0 : -1.0;
  const Vector3d knuckles[] = {{3, -1, 4}, {9, 0, 3}, {9, 0, 1}, {9, 0, -1}, {9, 0, -3}};
  std::string parent;
  for (std::size_t joint = 0; joint < words.fingers.size(); ++joint) {
    const std::size_t finger = joint / 3;
    Vector3d step = finger == 0 ? Vector3d(2.5, -0.5, 1.5) : Vector3d(3, 0, 0);
    const bool is_last = joint % 3 == 2;
    Vector3d offset = joint % 3 == 0 ? knuckles[finger] : step;
    offset.x() *= side;
    step.x() *= side;
    const std::string name = with_side(words, words.fingers[joint], left);
    if (joint % 3 == 0) parent = with_side(words, words.hand, left);
    figure.add(name, parent, offset, is_last ? std::optional(step) : std::nullopt);
    parent = name;
  }
}

}  // namespace

std::size_t BuiltFigure::add(const std::string& name, const std::string& parent,
                             const Vector3d& offset_cm, std::optional<Vector3d> end_cm) {
  BuiltJoint joint{name, -1, offset_cm, end_cm};
  if (!parent.empty()) joint.parent = static_cast<int>(&at(parent) - joints_.data());
  joints_.push_back(joint);
  return joints_.size() - 1;
}

BuiltJoint& BuiltFigure::at(const std::string& name) {
  for (BuiltJoint& joint : joints_)
    if (joint.name == name) return joint;
  throw std::out_of_range("no joint " + name);
}

void BuiltFigure::put_above(const std::string& joint, const std::string& name, double share) {
  BuiltJoint above{name, at(joint).parent, share * at(joint).offset_cm};
  at(joint).offset_cm *= 1.0 - share;
  at(joint).parent = static_cast<int>(joints_.size());
  joints_.push_back(above);
}

void BuiltFigure::scramble_names() {
  std::map<std::string, std::string> renamed;
  for (std::size_t j = 0; j < joints_.size(); ++j)
    renamed[joints_[j].name] = "q" + std::to_string(j * 7919 % 1009);
  for (BuiltJoint& joint : joints_) joint.name = renamed[joint.name];
  for (auto* by_name : {&turns_, &positions_}) {
    std::map<std::string, Vector3d> values;
    for (const auto& [name, value] : *by_name) values[renamed[name]] = value;
    *by_name = values;
  }
}

void BuiltFigure::append(std::size_t index, std::string& hierarchy,
                         std::vector<std::size_t>& order) const {
  const BuiltJoint& joint = joints_[index];
  order.push_back(index);
  const bool is_root = joint.parent < 0;
  hierarchy += (is_root ? "ROOT " : "JOINT ") + joint.name + "\n{\n";
  hierarchy += "OFFSET " + numbers(joint.offset_cm) + "\nCHANNELS ";
  hierarchy += is_root || joint.has_positions ? "6 Xposition Yposition Zposition " : "3 ";
  hierarchy += "Zrotation Xrotation Yrotation\n";
  for (std::size_t child = 0; child < joints_.size(); ++child)
    if (joints_[child].parent == static_cast<int>(index)) append(child, hierarchy, order);
  if (joint.end_cm) hierarchy += "End Site\n{\nOFFSET " + numbers(*joint.end_cm) + "\n}\n";
  hierarchy += "}\n";
}

std::string BuiltFigure::bvh() const {
  std::string text = "HIERARCHY\n";
  std::vector<std::size_t> order;
  append(0, text, order);
  text += "MOTION\nFrames: 2\nFrame Time: 0.033333333\n";
  const auto value = [](const std::map<std::string, Vector3d>& values, const std::string& name) {
    const auto found = values.find(name);
    return found != values.end() ? found->second : Vector3d(0, 0, 0);
  };
  for (const bool is_turned : {false, true}) {
    for (const std::size_t j : order) {
      const BuiltJoint& joint = joints_[j];
      if (joint.parent < 0 || joint.has_positions)
        text += numbers(value(positions_, joint.name)) + " ";
      text += numbers(is_turned ? value(turns_, joint.name) : Vector3d(0, 0, 0)) + " ";
    }
    text += "\n";
  }
  return text;
}

std::string BuiltFigure::glb(const std::string& moved, const Vector3d& place_m) const {
  std::string bin;
  for (const double time_s : {0.0, 0.1}) append_float(bin, time_s);
  for (int key = 0; key < 2; ++key)
    for (const double value : place_m) append_float(bin, value);
  std::string nodes;
  std::string moved_node;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    std::string children;
    for (std::size_t child = 0; child < joints_.size(); ++child)
      if (joints_[child].parent == static_cast<int>(j))
        children += (children.empty() ? "" : ",") + std::to_string(child);
    if (joints_[j].name == moved) moved_node = std::to_string(j);
    nodes += std::string(j > 0 ? "," : "") + R"({"name":")" + joints_[j].name +
             R"(","translation":)" + json_array(0.01 * joints_[j].offset_cm) +
             (children.empty() ? "" : R"(,"children":[)" + children + "]") + "}";
  }
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
      R"(],"buffers":[{"byteLength":32}],"bufferViews":[{"buffer":0,"byteLength":8},)"
      R"({"buffer":0,"byteOffset":8,"byteLength":24}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[0.1]},{"bufferView":1,)"
      R"("componentType":5126,"count":2,"type":"VEC3"}],"animations":[{"channels":[{"sampler":0,)"
      R"("target":{"node":)" +
      moved_node + R"(,"path":"translation"}}],"samplers":[{"input":0,"output":1}]}]})";
  json.append((4 - json.size() % 4) % 4, ' ');
  std::string glb = "glTF";
  append_u32(glb, 2);
  append_u32(glb, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bin.size()));
  append_u32(glb, static_cast<std::uint32_t>(json.size()));
  glb += "JSON" + json;
  append_u32(glb, static_cast<std::uint32_t>(bin.size()));
  glb.append("BIN\0", 4);
  return glb + bin;
}

std::string with_side(const RigWords& words, const std::string& word, bool left) {
  std::string name = word;
  const std::size_t at = name.find('<');
  if (at != std::string::npos) name.replace(at, 1, left ? words.left : words.right);
  return name;
}

std::vector<std::string> mixamo_fingers() {
  std::vector<std::string> names;
  for (const char* finger : {"Thumb", "Index", "Middle", "Ring", "Pinky"})
    for (const char* number : {"1", "2", "3"})
      names.push_back("<Hand" + std::string(finger) + number);
  return names;
}

BuiltFigure built_human(const RigWords& words) {
  BuiltFigure figure;
  figure.add(words.hips, "", {0, 95, 0});
  figure.set_position(words.hips, {0, 95, 0});
  figure.add(words.spine, words.hips, {0, 10, 0});
  figure.add(words.chest, words.spine, {0, 14, 0});
  figure.add(words.neck, words.chest, {0, 24, 0});
  figure.add(words.head, words.neck, {0, 10, 0}, Vector3d(0, 18, 0));
  for (const bool left : {true, false}) {
    const double side = left ? 1.0 : -1.0;
    const auto name = [&](const std::string& word) { return with_side(words, word, left); };
    figure.add(name(words.collar), words.chest, {3 * side, 18, 0});
    figure.add(name(words.upper_arm), name(words.collar), {14 * side, 0, 0});
    figure.add(name(words.lower_arm), name(words.upper_arm), {28 * side, 0, 0});
    figure.add(name(words.hand), name(words.lower_arm), {25 * side, 0, 0},
               words.fingers.empty() ? std::optional(Vector3d(17 * side, 0, 0)) : std::nullopt);
    add_fingers(words, left, figure);
    figure.add(name(words.thigh), words.hips, {9 * side, -4, 0});
    figure.add(name(words.shin), name(words.thigh), {0, -42, 0});
    figure.add(name(words.foot), name(words.shin), {0, -41, 0});
    figure.add(name(words.toes), name(words.foot), {0, -6, 14}, Vector3d(0, -2, 6));
  }
  return figure;
}

}  // namespace dance::test
