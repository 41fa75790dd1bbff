#include "tests/formats/avatar/tiny_avatar.h"

#include <algorithm>

namespace dance::test {
namespace {

void put_u32(Bytes& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::string filled(std::string pattern, const std::string& side, int number = 0) {
  if (const auto at = pattern.find('%'); at != pattern.npos) pattern.replace(at, 1, side);
  if (const auto at = pattern.find('#'); at != pattern.npos)
    pattern.replace(at, 1, std::to_string(number));
  return pattern;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (i + 1 < bytes.size()) three |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (i + 2 < bytes.size()) three |= bytes[i + 2];
    for (int k = 0; k < 4; ++k)
      out += i + static_cast<std::size_t>(k) > bytes.size() ? '='
                                                            : kLetters[three >> (18 - 6 * k) & 63];
  }
  return out;
}

}  // namespace

Bytes glb_of(std::string text, const Bytes& bin) {
  while (text.size() % 4 != 0) text += ' ';
  Bytes padded = bin;
  while (padded.size() % 4 != 0) padded.push_back(0);
  Bytes out;
  put_u32(out, 0x46546c67);
  put_u32(out, 2);
  put_u32(out, 20 + text.size() + (bin.empty() ? 0 : 8 + padded.size()));
  put_u32(out, text.size());
  put_u32(out, 0x4e4f534a);
  out.insert(out.end(), text.begin(), text.end());
  if (bin.empty()) return out;
  put_u32(out, padded.size());
  put_u32(out, 0x004e4942);
  out.insert(out.end(), padded.begin(), padded.end());
  return out;
}

TinyAvatar::TinyAvatar(const ToolNames& names, bool faces_back) : front_(faces_back ? -1 : 1) {
  json["asset"]["version"] = "2.0";
  int last = -1;
  int hips = -1;
  for (std::size_t t = 0; t < names.trunk.size(); ++t) {
    const float part = static_cast<float>(t) / static_cast<float>(names.trunk.size());
    last = add_node(names.trunk[t], last, {0.0f, 1.0f + 0.4f * part, 0.0f});
    if (t == 0) hips = last;
  }
  const int legs = names.pelvis.empty() ? hips : add_node(names.pelvis, hips, {0.0f, 0.98f, 0.0f});
  add_limbs(names, true, last, legs);
  add_limbs(names, false, last, legs);
  for (std::size_t n = 0; n < names.neck.size(); ++n)
    last = add_node(names.neck[n], last, {0.0f, 1.5f + 0.1f * static_cast<float>(n), 0.0f});
  float side = 0.03f;
  for (const std::string& name : names.of_head) {
    add_node(name, last, {side * front_, 1.7f, 0.08f * front_});
    side = -side;
  }
}

void TinyAvatar::add_limbs(const ToolNames& names, bool is_left, int trunk, int legs) {
  const std::string& side = is_left ? names.left : names.right;
  const float x = is_left ? front_ : -front_;
  const auto add = [&](const std::string& pattern, int parent, float right, float up, float ahead) {
    return pattern.empty()
               ? parent
               : add_node(filled(pattern, side), parent, {x * right, up, front_ * ahead});
  };
  const int shoulder = add(names.shoulder, trunk, 0.05f, 1.42f, 0.0f);
  const int upper = add(names.upper_arm, shoulder, 0.2f, 1.42f, 0.0f);
  const int lower = add(names.lower_arm, upper, 0.45f, 1.42f, 0.0f);
  const int hand = add(names.hand, lower, 0.7f, 1.42f, 0.0f);
  for (std::size_t f = 0; f < names.fingers.size(); ++f) {
    int above = hand;
    for (int k = 1; k <= 3 && !names.fingers[f].empty(); ++k)
      above = add_node(filled(names.fingers[f], side, k), above,
                       {x * (0.75f + 0.03f * static_cast<float>(k)), 1.42f,
                        front_ * (0.05f - 0.02f * static_cast<float>(f))});
  }
  const int thigh = add(names.thigh, legs, 0.1f, 0.95f, 0.0f);
  const int shin = add(names.shin, thigh, 0.1f, 0.5f, 0.0f);
  const int foot = add(names.foot, shin, 0.1f, 0.08f, 0.0f);
  add(names.toes, foot, 0.1f, 0.02f, 0.12f);
}

int TinyAvatar::add_node(const std::string& name, int parent, const Eigen::Vector3f& at) {
  const int index = static_cast<int>(places_.size());
  const Eigen::Vector3f offset =
      parent >= 0 ? (at - places_[static_cast<std::size_t>(parent)]).eval() : at;
  json["nodes"].push_back({{"name", name}, {"translation", {offset.x(), offset.y(), offset.z()}}});
  if (parent >= 0) json["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
  nodes_[name] = index;
  places_.push_back(at);
  return index;
}

std::size_t TinyAvatar::components(const std::string& type) {
  if (type == "MAT4") return 16;
  return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

int TinyAvatar::add_view(std::span<const std::uint8_t> bytes, int stride) {
  while (bin_.size() % 4 != 0) bin_.push_back(0);
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", bytes.size()}};
  if (stride > 0) view["byteStride"] = stride;
  bin_.insert(bin_.end(), bytes.begin(), bytes.end());
  json["bufferViews"].push_back(view);
  return static_cast<int>(json["bufferViews"].size()) - 1;
}

int TinyAvatar::add_accessor(int view, int component_type, const std::string& type,
                             std::size_t count, std::size_t offset, bool is_normalized) {
  nlohmann::json accessor = {{"componentType", component_type}, {"type", type}, {"count", count}};
  if (view >= 0) accessor["bufferView"] = view;
  if (offset > 0) accessor["byteOffset"] = offset;
  if (is_normalized) accessor["normalized"] = true;
  json["accessors"].push_back(accessor);
  return static_cast<int>(json["accessors"].size()) - 1;
}

int TinyAvatar::add_floats(std::vector<float> values, const std::string& type) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  return add_accessor(add_view({bytes, values.size() * sizeof(float)}), 5126, type,
                      values.size() / components(type));
}

nlohmann::json TinyAvatar::square() {
  const int places =
      add_floats({-0.1f, 0.9f, 0, 0.1f, 0.9f, 0, 0.1f, 1.1f, 0, -0.1f, 1.1f, 0}, "VEC3");
  const int normals = add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int uv = add_floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  const int joints = add_integers<std::uint8_t>(Bytes(16, 0), "VEC4");
  const int weights = add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int indices = add_integers<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  return {{"attributes",
           {{"POSITION", places},
            {"NORMAL", normals},
            {"TEXCOORD_0", uv},
            {"JOINTS_0", joints},
            {"WEIGHTS_0", weights}}},
          {"indices", indices}};
}

int TinyAvatar::add_mesh(nlohmann::json primitives, bool is_skinned, int parent) {
  if (!primitives.is_array()) primitives = nlohmann::json::array({primitives});
  json["meshes"].push_back({{"primitives", primitives}});
  const int node = add_node("mesh", parent, {0, 0, 0});
  auto& to = json["nodes"][static_cast<std::size_t>(node)];
  to["mesh"] = json["meshes"].size() - 1;
  if (!is_skinned) return node;
  if (!json.contains("skins")) {
    nlohmann::json joints = nlohmann::json::array();
    std::vector<float> matrices;
    for (std::size_t n = 0; n + 1 < places_.size(); ++n) {
      joints.push_back(n);
      const Eigen::Vector3f& at = places_[n];
      matrices.insert(matrices.end(),
                      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -at.x(), -at.y(), -at.z(), 1});
    }
    const int accessor = add_floats(matrices, "MAT4");
    json["skins"].push_back({{"joints", joints}, {"inverseBindMatrices", accessor}});
  }
  to["skin"] = 0;
  return node;
}

int TinyAvatar::add_picture(std::span<const std::uint8_t> bytes, const std::string& mime) {
  const int view = add_view(bytes);
  json["images"].push_back({{"bufferView", view}, {"mimeType", mime}});
  json["textures"].push_back({{"source", json["images"].size() - 1}});
  return static_cast<int>(json["textures"].size()) - 1;
}

Bytes TinyAvatar::glb(std::size_t kept_bytes) const {
  nlohmann::json out = json;
  const std::size_t kept = std::min(kept_bytes, bin_.size());
  if (kept > 0) out["buffers"] = {{{"byteLength", kept}}};
  return glb_of(out.dump(), Bytes(bin_.begin(), bin_.begin() + static_cast<std::ptrdiff_t>(kept)));
}

Bytes TinyAvatar::gltf() const {
  nlohmann::json out = json;
  out["buffers"] = {{{"byteLength", bin_.size()},
                     {"uri", "data:application/octet-stream;base64," + base64(bin_)}}};
  const std::string text = out.dump();
  return {text.begin(), text.end()};
}

}  // namespace dance::test
