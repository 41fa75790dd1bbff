// Recorded salsa couples before the simulated network, each hiding the other.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <numbers>

#include "producers/camera/people/people_tracker.h"
#include "producers/camera/solver/body_solver.h"
#include "research/capture/shown_cases.h"
#include "research/codec_takes.h"
#include "testing/camera/couple_scene.h"

namespace dance {
namespace {

constexpr double kTakeHz = 30.0;
constexpr double kFullyHidden = 0.7;

std::string take(int subject, const char* number) {
  return DANCE_SOURCE_DIR "/../shared/data/mocap/cmu_" + std::to_string(subject) + "_" + number +
         "_salsa.bvh.xz";
}

struct Tally {
  int frames = 0, right = 0, wrong = 0, longest_wrong = 0, hold = 0;
  double together_mm = 0.0, alone_mm = 0.0;  // sums of wrists in hold
};

// Wrists beside the middle of the hips, as the solver has them; the truth is the scene's.
double wrists_off_mm(const BodySolver& solver, const Pose& pose, const CaptureScene& scene,
                     std::size_t frame) {
  BodyFrames body;
  forward_kinematics(solver.skeleton(), pose, body);
  const auto at = [&](Bone bone) { return Eigen::Vector3d(body.position(bone).cast<double>()); };
  const auto& truth = scene.frames[frame].truth_W_m;
  const auto is = [&](Landmark l) { return truth[index_of(l)]; };
  const Eigen::Vector3d shown_hips = 0.5 * (at(Bone::kLeftUpperLeg) + at(Bone::kRightUpperLeg)),
                        hips = 0.5 * (is(Landmark::kLeftHip) + is(Landmark::kRightHip));
  return 500.0 * ((at(Bone::kLeftHand) - shown_hips - is(Landmark::kLeftWrist) + hips).norm() +
                  (at(Bone::kRightHand) - shown_hips - is(Landmark::kRightWrist) + hips).norm());
}

void judge(const char* number, double angle_rad, Tally& tally) {
  std::array<CoupleDancer, 2> dancers;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto loaded = load_codec_take(take(60 + static_cast<int>(i), number), kTakeHz);
    ASSERT_TRUE(loaded) << loaded.error().what;
    dancers[i].skeleton = loaded->skeleton;
    dancers[i].poses = turned_poses(loaded->poses, angle_rad);
  }
  const PictureColour white(0.9f, 0.5f, 0.5f), blue(0.3f, 0.65f, 0.45f), red(0.35f, 0.45f, 0.75f),
      skin(0.6f, 0.42f, 0.6f);
  dancers[0].clothes = {white, blue, blue, skin};
  dancers[1].clothes = {red, red, skin, skin};
  CoupleScene scene(dancers, kTakeHz, {}, {}, 5);
  PeopleTracker tracker({});
  const auto shared = make_shared_placement();
  std::vector<BodySolver> together, alone;
  for (int i = 0; i < 2; ++i) {
    together.emplace_back(SolverOptions{}, scene.scene(0).camera.pinhole, shared);
    alone.emplace_back(SolverOptions{}, scene.scene(0).camera.pinhole);
  }
  std::array<std::size_t, 2> person{0, 1};
  std::array<int, 2> run{};
  bool is_numbered = false;
  for (std::size_t f = 0; f < scene.frames(); ++f) {
    scene.show(f);
    const auto people = tracker.update(scene, scene.time(f));
    for (std::size_t i = 0; i < 2 && !is_numbered; ++i)
      if (people[i].is_found) {
        person[i] = scene.nearer(f, people[i].body);
        person[1 - i] = 1 - person[i];
        is_numbered = true;
      }
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t who = person[i];
      const bool is_wrong = people[i].is_found && scene.nearer(f, people[i].body) != who;
      run[i] = is_wrong ? run[i] + 1 : 0;
      tally.longest_wrong = std::max(tally.longest_wrong, run[i]);
      if (scene.hidden(f, who) < kFullyHidden) {
        ++tally.frames;
        tally.wrong += is_wrong ? 1 : 0;
        tally.right += people[i].is_found && !is_wrong ? 1 : 0;
      }
      BodyLandmarks seen;
      seen.found = people[i].is_found;
      seen.is_new = people[i].is_new;
      seen.presence = people[i].body.presence;
      seen.capture_time = scene.time(f);
      seen.region = people[i].region;
      seen.image_px = people[i].body.image_px;
      seen.world_m = people[i].body.world_m;
      seen.visibility = people[i].body.visibility;
      Pose both, single;
      const bool is_shown = together[i].solve(seen, std::nullopt, both);
      const bool is_alone =
          alone[i].solve(scene.scene(who).frames[f].landmarks, std::nullopt, single);
      if (f < 60 || !is_shown || !is_alone || !scene.is_in_hold(f)) continue;
      ++tally.hold;
      tally.together_mm += wrists_off_mm(together[i], both, scene.scene(who), f);
      tally.alone_mm += wrists_off_mm(alone[i], single, scene.scene(who), f);
    }
  }
}

TEST(CaptureCoupleTakes, IdentitiesAreKeptAndHandsInHoldAreTheirOwn) {
  if (!std::filesystem::exists(take(60, "05")))
    GTEST_SKIP() << "no recorded takes here: " << take(60, "05");
  Tally tally;
  for (const char* number : {"03", "05"})
    for (const double angle_deg : {0.0, 50.0})
      judge(number, angle_deg * std::numbers::pi / 180.0, tally);
  ASSERT_GT(tally.frames, 4000);
  EXPECT_LE(tally.wrong, tally.frames / 100) << "of " << tally.frames;
  EXPECT_LE(tally.longest_wrong, 15) << "frames, of 30 a second";
  EXPECT_GE(tally.right, tally.frames * 85 / 100);
  ASSERT_GT(tally.hold, 1000);
  EXPECT_LE(tally.together_mm, 1.3 * tally.alone_mm);
  std::printf("%d frames: %d right, %d wrong; wrists in hold %.1f mm, alone %.1f\n", tally.frames,
              tally.right, tally.wrong, tally.together_mm / tally.hold,
              tally.alone_mm / tally.hold);
}

}  // namespace
}  // namespace dance
