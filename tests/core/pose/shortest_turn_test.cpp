#include "core/pose/shortest_turn.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(ShortestTurn, TurnsEveryDirectionIntoEveryOther) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10'000; ++i) {
    const Vector3d from(normal(random), normal(random), normal(random));
    const Vector3d to = 5.0 * Vector3d(normal(random), normal(random), normal(random));
    const Quaterniond turn = shortest_turn(from, to);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-12);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-12);
    // The shortest: by the angle between them, and no more.
    const double between = std::atan2(from.cross(to).norm(), from.dot(to));
    EXPECT_NEAR(turn.angularDistance(Quaterniond::Identity()), between, 1e-9);
  }
}

TEST(ShortestTurn, TurnsByHalfIntoTheOpposite) {
  for (const Vector3d& from : {Vector3d(1, 0, 0), Vector3d(0, -2, 0), Vector3d(0.3, 0.1, -4)}) {
    EXPECT_LT((shortest_turn(from, -3.0 * from) * from + from).norm(), 1e-12);
    // And next to it, where the axis is all but lost.
    for (const double off : {1e-9, 1e-7, 1e-5, 1e-3}) {
      const Vector3d to = -from + off * Vector3d(0.5, 0.2, 0.7);
      EXPECT_LT((shortest_turn(from, to) * from.normalized() - to.normalized()).norm(), 1e-5)
          << off;
    }
  }
}

TEST(ShortestTurn, LeavesWhatHasNoDirection) {
  EXPECT_EQ(shortest_turn(Vector3d::Zero(), Vector3d::UnitX()).w(), 1.0);
  EXPECT_EQ(shortest_turn(Vector3d::UnitX(), Vector3d::UnitX()).w(), 1.0);
}

}  // namespace
}  // namespace dance
