// FigurePoser: how the figures on the stage stand at one moment: each guest's pose put onto the
// bones of that guest's avatar, whatever its proportions and names, with feet on the floor and with
// hands that meet where the dancers' hands do. All guests together, as couples touch.
//
// Units/frames: metres in W. A joint's matrix takes vertices of the model to W.
// Ownership:    keeps a rig for each guest from picture to picture, and what it returns until the
//               next call. Shares the models.
// Threads:      none inside; one owner.
// Failure:      none: a guest whose avatar is null is left out.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/base/guest_id.h"
#include "core/pose/kinematics.h"
#include "formats/avatar/avatar_model.h"
#include "viewer/figure/face/dancer_view.h"
#include "viewer/figure/hand_contact.h"
#include "viewer/scene/scene.h"

namespace dance {

// Three rows of a matrix, as a shader takes them.
using JointMatrix = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

struct PosedFigure {
  GuestId id;
  std::shared_ptr<const AvatarModel> model;
  std::vector<JointMatrix> W_from_joint;         // of each AvatarJoint
  std::vector<float> morph_weights;              // of each AvatarMorph, 0..1
  BodyFrames frames;                             // where the bones of the figure came to be
  std::array<float, 2> arm_stretch{1.0f, 1.0f};  // left, right: so much longer than they are
  float opacity = 1.0f;
};

// What an evaluation leaves out, to see what it brings.
struct FigureOptions {
  bool fits_feet = true;
  bool fits_hands = true;
  bool shares_twist = true;
  // Of all figures' springs together, in SpringChains::work(): the first guests' swing, those
  // beyond are at rest, so that no crowd of strangers' avatars slows the drawing.
  std::size_t most_spring_work = std::size_t{1} << 15;
};

class FigurePoser {
 public:
  explicit FigurePoser(FigureOptions options = {});
  ~FigurePoser();
  FigurePoser(const FigurePoser&) = delete;
  FigurePoser& operator=(const FigurePoser&) = delete;

  // Figures in the order of scene.guests. Hair and cloth swing with scene.time; a scene of an
  // earlier moment, or of much later, finds them at rest. Allocates only for guests, avatars and
  // proportions that are new.
  std::span<const PosedFigure> pose(const SceneState& scene);

 private:
  struct Rig;
  struct Shape;
  Rig& rig_of(const SceneGuest& guest, std::size_t place);
  std::shared_ptr<const AvatarShape> shape_of_model(
      const std::shared_ptr<const AvatarModel>& model);
  void show(const SceneGuest& guest, const SceneState& scene, std::size_t place);
  // Sets the weights of the morphs; returns the gaze for eyes with nodes.
  std::array<float, 2> show_face(const SceneGuest& guest, const SceneState& scene,
                                 std::size_t place);

  const FigureOptions options_;
  std::vector<std::unique_ptr<Rig>> rigs_;  // in the order of the last picture's guests
  std::vector<Shape> shapes_;
  std::vector<FigureFit> fits_;
  std::vector<PosedFigure> figures_;  // more than are shown, when there were more
  std::vector<DancerView> views_;
  HandContacts contacts_;
  std::size_t spring_work_left_ = 0;  // in this picture
};

}  // namespace dance
