// ShownFigure: reads places and turns off a figure as it is drawn: from the matrices of its joints
// alone.
//
// Units/frames: metres in W.
// Ownership:    refers to the model.
// Threads:      none inside.
// Failure:      nullopt for nodes that no vertex is tied to, nor a node near them.
#pragma once

#include <optional>
#include <vector>

#include "viewer/figure/figure_poser.h"

namespace dance {

class ShownFigure {
 public:
  explicit ShownFigure(const AvatarModel& model);

  Eigen::Vector3f palm_W_m(const PosedFigure& figure, std::size_t side) const;
  // The lowest of the vertices that mostly follow a foot and its toes.
  std::optional<float> sole_W_m(const PosedFigure& figure, std::size_t side) const;
  // How far the mesh is twisted at a joint of the arm, about the forearm.
  double wrist_twist_rad(const PosedFigure& figure, std::size_t side) const;
  double elbow_twist_rad(const PosedFigure& figure, std::size_t side) const;

 private:
  std::optional<Eigen::Quaternionf> turn_of(const PosedFigure& figure, int node) const;
  double twist_between(const PosedFigure& figure, std::size_t side, int first, int second) const;

  const AvatarModel& model_;
  std::vector<Eigen::Affine3f> M_from_node_;
  std::vector<int> joint_of_;                        // of each node; -1 = none
  std::array<int, 2> last_forearm_{};                // the node of the forearm nearest to the hand
  std::array<std::vector<std::uint32_t>, 2> soles_;  // vertices
};

}  // namespace dance
