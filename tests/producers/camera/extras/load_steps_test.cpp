#include "producers/camera/extras/load_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace dance {
namespace {

// Pictures at 30 Hz; what each takes is said by its step.
struct Machine {
  std::array<double, 5> busy_ms{};  // of each LoadStep
  LoadSteps steps;
  MonoTime now = MonoTime{} + Duration::s(1);
  int changes = 0;

  void run(double seconds) {
    for (double t = 0.0; t < seconds;) {
      const double busy = busy_ms[static_cast<std::size_t>(steps.step())];
      const double period = std::max(1000.0 / 30.0, busy);
      now = now + Duration::seconds(period * 1e-3);
      if (steps.add(Duration::seconds(busy * 1e-3), Duration::seconds(period * 1e-3), now))
        ++changes;
      t += period * 1e-3;
    }
  }
};

TEST(LoadSteps, AFastMachineSeesAll) {
  Machine machine;
  machine.busy_ms = {25.0, 20.0, 15.0, 10.0};
  machine.run(60.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kAll);
  EXPECT_EQ(machine.changes, 0);
}

TEST(LoadSteps, ASlowerOneStepsDownToWhatItCanDoAndStaysThere) {
  Machine machine;
  machine.busy_ms = {45.0, 34.0, 24.0, 18.0};
  machine.run(6.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kOneInTurn);
  EXPECT_EQ(machine.changes, 2);
  machine.run(300.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kOneInTurn);
  EXPECT_EQ(machine.changes, 2);
}

TEST(LoadSteps, TheSlowestSeesTheBodyOnly) {
  Machine machine;
  machine.busy_ms = {90.0, 80.0, 70.0, 60.0};
  machine.run(12.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kBodyOnly);
}

TEST(LoadSteps, TriesMoreOnceTheMachineIsIdleAgainAndLessOftenWhereThatFails) {
  Machine machine;
  machine.busy_ms = {45.0, 24.0, 15.0, 10.0};
  machine.run(5.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kAlternating);
  machine.busy_ms = {20.0, 14.0, 12.0, 10.0};
  machine.run(15.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kAll);
  // It looks light, and is too much each time.
  machine.busy_ms = {45.0, 14.0, 12.0, 10.0};
  machine.changes = 0;
  machine.run(600.0);
  EXPECT_LE(machine.changes, 16);
}

TEST(LoadSteps, APictureThatTakesNoTimeSaysNothing) {
  LoadSteps steps;
  const MonoTime now = MonoTime{} + Duration::s(1);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(steps.add(Duration::ms(5), Duration{}, now));
  EXPECT_EQ(steps.step(), LoadStep::kAll);
}

TEST(LoadSteps, SeveralDancersAreSeenByTurnsAtLast) {
  Machine machine;
  machine.steps = LoadSteps(LoadStep::kBodyOnly, LoadStep::kDancersByTurns);
  machine.busy_ms = {0.0, 0.0, 0.0, 40.0, 20.0};
  EXPECT_EQ(machine.steps.step(), LoadStep::kBodyOnly);
  machine.run(60.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kDancersByTurns);
  machine.busy_ms = {0.0, 0.0, 0.0, 15.0, 8.0};
  machine.run(400.0);
  EXPECT_EQ(machine.steps.step(), LoadStep::kBodyOnly) << "and no more than there is";
}

}  // namespace
}  // namespace dance
