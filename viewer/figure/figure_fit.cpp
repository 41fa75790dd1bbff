#include "viewer/figure/figure_fit.h"

namespace dance {

using Eigen::Vector3f;

void place_on_bones(const Skeleton& dancer, const Pose& pose, FigureFit& fit) {
  const AvatarRig& rig = *fit.rig;
  forward_kinematics(dancer, pose, fit.danced);
  if (rig.is_own_body) {
    fit.frames = fit.danced;
    return;
  }
  Pose folded = pose;
  rig.fold(folded);
  // The middle between the hip joints comes to where the dancer's is, as high as the legs are long:
  // where a model's hips node lies in its trunk is its maker's choice.
  const auto middle = [](const Skeleton& body) {
    return Vector3f(0.5f * (body.offset(Bone::kLeftUpperLeg) + body.offset(Bone::kRightUpperLeg)));
  };
  Vector3f place = pose.p_WH_m + pose.R_PB[0] * middle(dancer);
  place.y() *= rig.leg_ratio;
  folded.p_WH_m = place - folded.R_PB[0] * middle(rig.body);
  forward_kinematics(rig.body, folded, fit.frames);
}

}  // namespace dance
