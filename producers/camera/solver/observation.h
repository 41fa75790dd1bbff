// Observation: one picture's landmarks as measurements: rays instead of pixels, a weight for each
// point, all finite. The only place that checks them.
//
// Units/frames: rays are x/z and y/z in C (producers/camera/pinhole.h), freed from the lens'
//               distortion; world points in metres of the network.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_usable is false where too little of a body is seen to place it; weights of
//               points that are not finite, far outside the picture or marked as hidden are 0.
#pragma once

#include <Eigen/Core>
#include <array>

#include "producers/camera/body_landmarks.h"
#include "producers/camera/pinhole.h"

namespace dance {

struct Observation {
  bool is_usable = false;
  std::array<Eigen::Vector2d, kLandmarkCount> ray;
  std::array<Eigen::Vector3d, kLandmarkCount> world_m;
  std::array<double, kLandmarkCount> weight{};        // 0…1, of the ray
  std::array<double, kLandmarkCount> world_weight{};  // 0…1
  double ray_sd = 0.0;                                // of one coordinate of a ray
  double visible = 0.0;                               // mean weight of the joints of the body

  double weight_of(Landmark l) const { return weight[index_of(l)]; }
  const Eigen::Vector3d& world(Landmark l) const { return world_m[index_of(l)]; }
};

Observation observe(const BodyLandmarks& landmarks, const Pinhole& camera);

// Where a body whose points relative to some place of it are `relative_C_m` must be so that they
// are seen on their rays: least squares in x/z and y/z over the points with a weight. Says whether
// it is in front of the camera.
//   t_x − a t_z = a Z − X,  t_y − e t_z = e Z − Y   for a ray (a, e) and a point (X, Y, Z)
bool place_on_rays(const Observation& seen,
                   const std::array<Eigen::Vector3d, kLandmarkCount>& relative_C_m,
                   Eigen::Vector3d& place_C_m);

// The same least squares of the rays of several cameras, added one after the other.
class RayPlace {
 public:
  RayPlace() : A_(1e-6 * Eigen::Matrix3d::Identity()), b_(Eigen::Vector3d::Zero()) {}
  // Rays of a camera whose frame V is that of the place, C, turned by `R_VC` and moved by `p_VC_m`.
  void add(const Observation& seen, const Eigen::Matrix3d& R_VC, const Eigen::Vector3d& p_VC_m,
           double trust, const std::array<Eigen::Vector3d, kLandmarkCount>& relative_C_m);
  bool solve(Eigen::Vector3d& place_C_m) const;

 private:
  Eigen::Matrix3d A_;
  Eigen::Vector3d b_;
};

}  // namespace dance
