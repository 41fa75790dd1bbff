// Avatars small enough to be written down: a figure by the names of some tool, and meshes,
// materials and extensions on it, as JSON and bytes, made without the reader's own code.
//
// Units/frames: metres, as glTF; the figure stands in T-pose and faces +Z, or -Z.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/pose/bone.h"

namespace dance::test {

using Bytes = std::vector<std::uint8_t>;

// '%' stands for the side, '#' for a finger's 1, 2, 3.
struct ToolNames {
  std::string left = "left";
  std::string right = "right";
  std::vector<std::string> trunk{"hips", "spine", "chest"};
  std::string pelvis;  // of the legs, beside the spine; "" = they hang from the trunk's first
  std::vector<std::string> neck{"neck", "head"};
  std::string shoulder = "%Shoulder";
  std::string upper_arm = "%UpperArm";
  std::string lower_arm = "%LowerArm";
  std::string hand = "%Hand";
  std::string thigh = "%UpperLeg";
  std::string shin = "%LowerLeg";
  std::string foot = "%Foot";
  std::string toes = "%Toes";
  std::array<std::string, 5> fingers{};  // thumb to little; "" = none
  std::vector<std::string> of_head{};    // what hangs from the head
};

class TinyAvatar {
 public:
  explicit TinyAvatar(const ToolNames& names = {}, bool faces_back = false);

  // A node in the place `at` of the world (no node of the figure is turned).
  int add_node(const std::string& name, int parent, const Eigen::Vector3f& at);
  int node(const std::string& name) const { return nodes_.at(name); }

  int add_view(std::span<const std::uint8_t> bytes, int stride = 0);
  int add_accessor(int view, int component_type, const std::string& type, std::size_t count,
                   std::size_t offset = 0, bool is_normalized = false);
  int add_floats(std::vector<float> values, const std::string& type);
  template <class Integer>
  int add_integers(const std::vector<Integer>& values, const std::string& type,
                   bool is_normalized = false) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    const int component_type = sizeof(Integer) == 1 ? 5121 : sizeof(Integer) == 2 ? 5123 : 5125;
    return add_accessor(add_view({bytes, values.size() * sizeof(Integer)}), component_type, type,
                        values.size() / components(type), 0, is_normalized);
  }
  // A square of four corners at the hips, all tied to the hips: two triangles facing +Z.
  nlohmann::json square();
  // Puts primitives on a node of their own, with the skin of all nodes or without.
  int add_mesh(nlohmann::json primitives, bool is_skinned = true, int parent = -1);
  int add_picture(std::span<const std::uint8_t> bytes, const std::string& mime);

  // A GLB, with no more than these bytes of its buffer, or a .gltf with the buffer as a data URI.
  Bytes glb(std::size_t kept_bytes = std::size_t{1} << 30) const;
  std::size_t bin_bytes() const { return bin_.size(); }
  Bytes gltf() const;

  nlohmann::json json;

 private:
  static std::size_t components(const std::string& type);
  void add_limbs(const ToolNames& names, bool is_left, int trunk, int legs);

  float front_ = 1.0f;
  Bytes bin_;
  std::map<std::string, int> nodes_;
  std::vector<Eigen::Vector3f> places_;
};

Bytes glb_of(std::string json, const Bytes& bin);

}  // namespace dance::test
