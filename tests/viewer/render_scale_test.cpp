// The scale falls on a slow machine, and rises when there is time.
#include "viewer/display/render_scale.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

// A machine whose pictures take a fixed time and a time for all pixels.
struct Machine {
  void run(Duration duration) {
    for (const MonoTime end = now + duration; now < end;) {
      const double share = static_cast<double>(scale.scale()) * static_cast<double>(scale.scale());
      const Duration drawing = Duration::seconds(1e-3 * (fixed_ms + share * pixels_ms));
      now += drawing;
      scale.on_picture(drawing, now);
      changes += scale.scale() != last ? 1 : 0;
      last = scale.scale();
    }
  }

  RenderScale scale;
  double fixed_ms = 3.0, pixels_ms = 10.0;
  float last = 1.0f;
  int changes = 0;
  MonoTime now = MonoTime::from_us(50'000'000);
};

TEST(RenderScale, KeepsAllPixelsOnAFastMachine) {
  Machine machine;
  machine.run(Duration::s(30));
  EXPECT_EQ(machine.changes, 0);
}

TEST(RenderScale, FallsWithinSecondsAndRisesWhenTheMachineIsFreeAgain) {
  Machine machine;
  machine.pixels_ms = 120.0;
  machine.run(Duration::s(6));
  EXPECT_LT(machine.scale.scale(), 0.7f);
  machine.pixels_ms = 10.0;
  machine.run(Duration::s(60));
  EXPECT_EQ(machine.scale.scale(), 1.0f);
}

TEST(RenderScale, SettlesWhereALargerScaleProvesTooSlow) {
  Machine machine;
  machine.pixels_ms = 60.0;
  machine.run(Duration::s(5));
  EXPECT_EQ(machine.scale.scale(), RenderScale::kScales[1]);
  EXPECT_FALSE(machine.scale.is_smallest());
  machine.changes = 0;
  machine.run(Duration::s(120));
  EXPECT_EQ(machine.changes, 0) << "its mean time shows that all pixels would take too long";
}

TEST(RenderScale, ReportsTheSmallestScaleOnASlowMachine) {
  Machine machine;
  machine.fixed_ms = 200.0;
  machine.run(Duration::s(8));
  EXPECT_TRUE(machine.scale.is_smallest());
}

}  // namespace
}  // namespace dance
