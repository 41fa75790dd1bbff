// A style from the one house's terminal to the other house's stage, through the programs.
#include <cmath>

#include "producers/salsa/salsa_dancer.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

const GuestId kStyledGuest = *GuestId::parse("alice");

class StylePrograms : public BusPrograms {
 protected:
  std::string talk() { return text_of(folder_.path("talk")); }
};

TEST_F(StylePrograms, SaidInATerminalReachesTheStageOfTheOtherHouseAndTop) {
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nbus = \"" << kOtherBus << "\"\nguests = [\"bob\"]\n"
      << "[[route]]\nfrom = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\n"
      << "through = [\"hold 20ms\", \"stylize mix=1\"]\n";
  start("dance-server", {"--port", "7457"});
  start("dance-link", {"--server", "127.0.0.1:7457", "--guest", "alice", "--bus", kBus,
                       "--bus-captures", "alice"});
  start("dance-link", {"--server", "127.0.0.1:7457", "--guest", "bob", "--bus", kOtherBus});
  start("dance-manager", {folder_.path("house.toml")});
  auto a = Bus::open(kBus), b = Bus::open(kOtherBus);
  ASSERT_TRUE(a && b);

  SalsaStyle salsa;
  salsa.role = SalsaRole::kFollow;
  SalsaDancer dancer(salsa);
  // How fast the arm turns on the stage, of how fast it was danced; both over about half a second.
  const std::size_t arm = index_of(Bone::kLeftUpperArm);
  Pose shown_before, danced_before;
  double shown = 0.0, danced = 0.0;
  std::size_t poses = 0;
  const auto add = [&](const Pose& pose, Pose& before, double& speed) {
    const double dt_s = (pose.capture_time - before.capture_time).as_seconds();
    if (before.clock_id != 0 && dt_s > 0.001 && dt_s < 0.2) {
      const auto turn = static_cast<double>(pose.R_PB[arm].angularDistance(before.R_PB[arm]));
      speed += 0.03 * (turn / dt_s - speed);
    }
    before = pose;
  };
  (*b)->subscribe<Pose>({Where::kStage, kStyledGuest},
                        [&](const Channel&, const Pose& pose, MonoTime) {
                          add(pose, shown_before, shown);
                          ++poses;
                        });
  const MonoTime begin = mono_now();
  std::uint32_t sequence = 0;
  const auto dance = [&] {
    const MonoTime now = mono_now();
    Pose pose;
    dancer.dance_at(now - begin, pose);
    pose.sequence = ++sequence;
    pose.clock_id = this_clock_id();
    pose.capture_time = now;
    add(pose, danced_before, danced);
    (*a)->publish(Channel::of(Signal::kSkeleton, Where::kCapture, kStyledGuest),
                  TimedSkeleton{dancer.skeleton(), now, this_clock_id()});
    (*a)->publish(Channel::of(Signal::kPose, Where::kCapture, kStyledGuest), pose);
    (*a)->drain(now);
    (*b)->drain(now);
  };
  ASSERT_TRUE(wait_for([&] {
    dance();
    return poses > 100 && shown > 0.6 * danced;
  })) << poses
      << " poses came\n"
      << talk();

  start("dance-style", {"alice", "arms=0", "--bus", kBus});
  EXPECT_TRUE(wait_for([&] {
    dance();
    return danced > 0.2 && shown < 0.35 * danced;
  })) << "the arms still turn at "
      << shown << " of " << danced << " rad/s\n"
      << talk();
  const Finished top = run(bin("dance-top") + " --once --bus " + quoted(kOtherBus));
  const std::size_t row = top.output.rfind("STYLE/guest/alice");
  ASSERT_NE(row, std::string::npos) << top.output;
  EXPECT_NE(top.output.substr(row).find("0.00"), std::string::npos) << top.output;
}

TEST_F(StylePrograms, OfSomebodyWhoIsNotThereIsSaid) {
  const Finished said =
      run(bin("dance-style") + " ghost hips=2 --seconds 3.5 --bus " + quoted(kBus));
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_TRUE(has_all(said.talk, {"ghost", "dance top"})) << said.talk;
}

TEST_F(StylePrograms, WrongWordsAreNamedWithWhatThereIs) {
  for (const char* wrong : {"nose=2", "hips", "hips=9", "preset=loud"}) {
    const Finished said = run(bin("dance-style") + " alice " + wrong);
    EXPECT_NE(said.exit_code, 0) << wrong;
    EXPECT_TRUE(has_all(said.talk, {"style"})) << said.talk;
  }
}

}  // namespace
}  // namespace dance
