// A house that sends a dancer out over VMC and takes the same back in as another: the lines of its
// session file, both ways, in one process.
#include <gtest/gtest.h>

#include <map>

#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

class HouseVmc : public BusPrograms {};

TEST_F(HouseVmc, SendsADancerOutAndTakesThemBackInAsAnother) {
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nbus = \"" << kBus << "\"\nguests = [\"alice\", \"carol\"]\n"
      << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"lead\"\n"
      << "[[produce]]\nkind = \"vmc\"\nguest = \"carol\"\nlisten = \"127.0.0.1:39577\"\n"
      << "[[listen]]\nto = \"vmc\"\nfrom = \"POSE/capture/alice\"\naddress = \"127.0.0.1:39577\"\n"
      << "dialect = \"vrm1\"\nrate = 30\n";
  auto bus = Bus::open(kBus);
  ASSERT_TRUE(bus) << bus.error().what;
  std::map<std::string, std::vector<Pose>> heard;
  std::map<std::string, Skeleton> bodies;
  (*bus)->subscribe<Pose>(Where::kStage, [&](const Channel& channel, const Pose& pose, MonoTime) {
    heard[std::string(channel.guest().view())].push_back(pose);
  });
  (*bus)->subscribe<TimedSkeleton>(
      Where::kStage, [&](const Channel& channel, const TimedSkeleton& timed, MonoTime) {
        bodies[std::string(channel.guest().view())] = timed.skeleton;
      });
  start("dance-join", {folder_.path("house.toml"), "--no-view"});
  ASSERT_TRUE(wait_for([&] {
    (*bus)->drain(mono_now());
    return heard["carol"].size() > 60 && bodies.size() == 2;
  })) << text_of(folder_.path("talk"));
  int found = 0;
  for (const Pose& carol : heard["carol"])
    for (const Pose& alice : heard["alice"])
      if ((carol.p_WH_m - alice.p_WH_m).norm() < 1e-6f) {
        ++found;
        for (std::size_t b = 0; b < kBoneCount; ++b)
          EXPECT_LT(carol.R_PB[b].angularDistance(alice.R_PB[b]), 1e-3f) << kBones[b].name;
        break;
      }
  EXPECT_GT(found, 50);
  // Half as many, by the rate.
  EXPECT_LT(heard["carol"].size(), heard["alice"].size() * 2 / 3);
  for (std::size_t b = 1; b < kBoneCount; ++b)
    EXPECT_LT((bodies["carol"].offset_m[b] - bodies["alice"].offset_m[b]).norm(), 1e-5f)
        << kBones[b].name;
}

}  // namespace
}  // namespace dance
