// Figures of 1.7 m in T-pose, built joint by joint with any names, as BVH text in centimetres or as
// a GLB in metres: small samples of what other programs export.
//
// Threads: none inside.
// Failure: none; a name that is not there is our bug and ends the test by an exception.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dance::test {

struct BuiltJoint {
  std::string name;
  int parent = -1;
  Eigen::Vector3d offset_cm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> end_cm = {};
  bool has_positions = false;
};

class BuiltFigure {
 public:
  std::size_t add(const std::string& name, const std::string& parent,
                  const Eigen::Vector3d& offset_cm,
                  std::optional<Eigen::Vector3d> end_cm = std::nullopt);
  // Puts a new joint between a joint and its parent, which takes `share` of the way.
  void put_above(const std::string& joint, const std::string& name, double share);
  void rename(const std::string& from, const std::string& to) { at(from).name = to; }
  // "joint1", "joint2" …, in an order that has no meaning.
  void scramble_names();

  // Angles of channels Zrotation Xrotation Yrotation in the second of the two frames.
  void turn(const std::string& name, const Eigen::Vector3d& zxy_deg) { turns_[name] = zxy_deg; }
  void set_position(const std::string& name, const Eigen::Vector3d& position_cm) {
    at(name).has_positions = true;
    positions_[name] = position_cm;
  }

  BuiltJoint& at(const std::string& name);
  const std::vector<BuiltJoint>& joints() const { return joints_; }
  std::string bvh() const;
  // The root's children as nodes without a skin below a node of their own; one animation moves
  // `moved` to `place_m`.
  std::string glb(const std::string& moved, const Eigen::Vector3d& place_m) const;

 private:
  void append(std::size_t joint, std::string& hierarchy, std::vector<std::size_t>& order) const;

  std::vector<BuiltJoint> joints_;
  std::map<std::string, Eigen::Vector3d> turns_;
  std::map<std::string, Eigen::Vector3d> positions_;
};

// The words of a rig; "<" stands for the side.
struct RigWords {
  std::string hips = "Hips", spine = "Spine", chest = "Spine1", neck = "Neck", head = "Head";
  std::string collar = "<Shoulder", upper_arm = "<Arm", lower_arm = "<ForeArm", hand = "<Hand";
  std::string thigh = "<UpLeg", shin = "<Leg", foot = "<Foot", toes = "<ToeBase";
  std::string left = "Left", right = "Right";
  // Thumb to little finger, three joints each; none where empty.
  std::vector<std::string> fingers = {};
};

std::string with_side(const RigWords& words, const std::string& word, bool left);

// Mixamo's words of fingers: LeftHandThumb1 …
std::vector<std::string> mixamo_fingers();

BuiltFigure built_human(const RigWords& words);

}  // namespace dance::test
