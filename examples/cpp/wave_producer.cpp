// wave_producer: a dancer who waves with the right hand, once a second. A Dancer says what the pose
// of a moment is; ProducerProgram paces it, stamps it and publishes it on POSE/capture/<guest>.

#include <cmath>

#include "core/program/program.h"
#include "producers/producer_program.h"

namespace {

class Waver : public dance::Dancer {
 public:
  const dance::Skeleton& skeleton() const override { return skeleton_; }
  double natural_hz() const override { return 60.0; }

  // Rotations are of a bone in its parent; all identities are a T-pose facing +Z, +Y up. The right
  // arm points to -X then: the upper arm turns up a little, the lower arm waves.
  void dance_at(dance::Duration t, dance::Pose& out) override {
    const auto about_z = [](float angle_rad) {
      return Eigen::Quaternionf(Eigen::AngleAxisf(angle_rad, Eigen::Vector3f::UnitZ()));
    };
    const auto wave_rad = static_cast<float>(0.5 * std::sin(2.0 * M_PI * t.as_seconds()));
    out.R_PB = dance::identity_rotations();
    out.R_PB[index_of(dance::Bone::kRightUpperArm)] = about_z(-0.4f);
    out.R_PB[index_of(dance::Bone::kRightLowerArm)] = about_z(-0.4f + wave_rad);
    out.R_PB[index_of(dance::Bone::kLeftUpperArm)] = about_z(-1.3f);  // hangs down
    out.p_WH_m = {0.0f, skeleton_.hips_height_m(), 0.0f};
  }

 private:
  dance::Skeleton skeleton_ = dance::average_skeleton(1.75f);
};

}  // namespace

int main(int argc, char** argv) {
  std::string guest = "waver";
  dance::ProducerOptions options;
  dance::CommandLine line("A dancer who waves.", "wave_producer");
  line.add("--guest", guest, "who dances").guest_name().shows_default();
  dance::add_producer_options(line, options);
  return dance::run_program(line, argc, argv, [&]() -> dance::Result<void> {
    DANCE_TRY(auto program, dance::ProducerProgram::open(options));
    program->add(std::make_unique<Waver>(), *dance::GuestId::parse(guest));
    program->run([] { return true; });
    return {};
  });
}
