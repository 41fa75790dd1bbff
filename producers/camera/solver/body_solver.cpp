#include "producers/camera/solver/body_solver.h"

#include <algorithm>
#include <cmath>

#include "producers/camera/solver/body_tracking.h"

namespace dance {

class BodySolver::Inside : public BodyTracking {
 public:
  using BodyTracking::BodyTracking;
};

std::shared_ptr<SharedPlacement> make_shared_placement() {
  return std::make_shared<SharedPlacement>();
}

BodySolver::BodySolver(const SolverOptions& options, const Pinhole& camera,
                       std::shared_ptr<SharedPlacement> shared)
    : inside_(std::make_unique<Inside>(options, camera, std::move(shared))) {}
BodySolver::~BodySolver() = default;
BodySolver::BodySolver(BodySolver&&) noexcept = default;
BodySolver& BodySolver::operator=(BodySolver&&) noexcept = default;

bool BodySolver::solve(const BodyLandmarks& landmarks, const std::optional<DepthHint>& depth,
                       Pose& out, OtherViews others) {
  return inside_->solve(landmarks, depth, out, others);
}
void BodySolver::take_lengths(const BodyLengths& lengths) { inside_->take_lengths(lengths); }
const Skeleton& BodySolver::skeleton() const { return inside_->skeleton(); }
double BodySolver::height_m() const { return inside_->height_m(); }
bool BodySolver::is_settled() const { return inside_->is_settled(); }
CameraStand BodySolver::camera_stand() const { return inside_->camera_stand(); }
void BodySolver::reset() { inside_->reset(); }

}  // namespace dance
