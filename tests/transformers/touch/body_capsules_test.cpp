#include "transformers/touch/body_capsules.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/transformers/touch/two_dancers.h"

namespace dance {
namespace {

using Eigen::Vector3f;

TEST(BodyCapsules, AreAsFarApartAsTheNearestOfTheirPoints) {
  Random random(11);
  const auto place = [&] {
    return Vector3f(static_cast<float>(random.uniform(-1.0, 1.0)),
                    static_cast<float>(random.uniform(-1.0, 1.0)),
                    static_cast<float>(random.uniform(-1.0, 1.0)));
  };
  for (int i = 0; i < 100; ++i) {
    Capsule a{place(), place(), 0.05f}, b{place(), place(), 0.1f};
    if (i % 10 == 0) a.to = a.from;
    if (i % 20 == 0) b.to = b.from;
    if (i % 7 == 0) b.to = b.from + (a.to - a.from);  // parallel
    float least = 1e9f;
    for (int s = 0; s <= 60; ++s)
      for (int t = 0; t <= 60; ++t)
        least = std::min(least, (a.from + (a.to - a.from) * (static_cast<float>(s) / 60.0f) -
                                 b.from - (b.to - b.from) * (static_cast<float>(t) / 60.0f))
                                    .norm());
    EXPECT_NEAR(nearness_of(a, b).distance_m, least - 0.15f, 0.03f) << i;
    EXPECT_LE(nearness_of(a, b).distance_m, least - 0.15f + 1e-4f) << i;
  }
}

TEST(BodyCapsules, GrowWithTheDancer) {
  BodyFrames frames;
  const Skeleton child = average_skeleton(1.1f), adult = average_skeleton(1.72f);
  forward_kinematics(child, Pose(), frames);
  const BodyCapsules small = BodyCapsules::of(child, frames);
  forward_kinematics(adult, Pose(), frames);
  const BodyCapsules usual = BodyCapsules::of(adult, frames);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_NEAR(small.of_bone[b].radius_m / usual.of_bone[b].radius_m, 1.1f / 1.72f, 0.02f);
  EXPECT_NEAR(usual.of_bone[index_of(Bone::kChest)].radius_m, 0.125f, 0.01f);
}

}  // namespace
}  // namespace dance
