// A house that is killed and started again, again and again, while an engine reads.
#include <gtest/gtest.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "consumers/engine/dance_adapter.h"
#include "consumers/engine/engine_consumer.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"

namespace dance {
namespace {

constexpr int kLives = 100;

std::string name() { return "killed-" + std::to_string(getppid()); }

// All values tell the number.
Pose numbered(std::uint32_t number) {
  Pose pose;
  pose.sequence = number;
  const float angle = 0.001f * static_cast<float>(number % 1000);
  pose.R_PB.fill(Eigen::Quaternionf(std::cos(angle), std::sin(angle), 0.0f, 0.0f));
  pose.p_WH_m.setConstant(0.5f * static_cast<float>(number % 1000));
  return pose;
}

bool is_whole(const dance_pose& pose) {
  const Pose wanted = numbered(pose.sequence);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if ((Eigen::Vector4f(pose.rotation[b]) - wanted.R_PB[b].coeffs()).norm() > 1e-5f) return false;
  return Eigen::Vector3f(pose.hips_position) == wanted.p_WH_m;
}

// A pose for a time is made of several: each of its rotations is one, and it stands on the stage.
bool is_sound(const dance_pose& pose) {
  for (const auto& q : pose.rotation)
    if (!(std::abs(Eigen::Vector4f(q).norm() - 1.0f) < 1e-3f)) return false;
  // Predicted at most some metres beyond the 500 of the dance.
  for (const float x : pose.hips_position)
    if (!(x >= -10.0f && x <= 510.0f)) return false;
  return pose.kind <= DANCE_POSE_HELD && pose.generation % 2 == 1;
}

// The longest call, in time of this thread on its processor: a machine with other work does not
// count, a reader that goes round and round for ever does.
class LongestCall {
 public:
  template <class Call>
  auto operator()(Call&& call) {
    const Duration begin = used();
    const auto answer = call();
    longest_ = std::max(longest_, used() - begin);
    return answer;
  }
  Duration longest() const { return longest_; }

 private:
  static Duration used() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return Duration::s(t.tv_sec) + Duration::ns(t.tv_nsec);
  }
  Duration longest_;
};
constexpr Duration kHangs = Duration::s(2);

// Writes as fast as it can until it is killed.
[[noreturn]] void live_and_write(const std::string& memory, std::uint32_t life) {
  auto consumer = EngineConsumer::open(memory, 0.0, this_clock_id(), mono_now());
  if (!consumer) _exit(3);
  const GuestId alice = *GuestId::parse("alice");
  for (std::uint32_t n = life * 1'000'000;; ++n) {
    Pose pose = numbered(n);
    const MonoTime now = mono_now();
    pose.clock_id = this_clock_id();
    pose.capture_time = now;
    (*consumer)->on_pose(alice, pose, now);
    (*consumer)->on_skeleton(alice, average_skeleton(1.5f + 0.1f * static_cast<float>(n % 3)), now);
  }
}

TEST(WriterKilled, AReaderGoesOnAfterEachOfAHundredDeaths) {
  const std::string memory = name();
  dance_adapter* adapter = dance_adapter_open(memory.c_str(), DANCE_AXES_GLTF);
  std::uint64_t torn = 0, fine = 0, unsound = 0;
  LongestCall timed;
  for (std::uint32_t life = 1; life <= kLives; ++life) {
    auto writer = ChildProcess::start_copy([&]() -> int { live_and_write(memory, life); });
    ASSERT_TRUE(writer) << writer.error().what;
    // Until it was seen, and some poses more; then it dies wherever it is.
    std::uint32_t seen = 0;
    const MonoTime give_up = mono_now() + Duration::s(60);
    dance_pose pose{};
    pose.struct_size = sizeof pose;
    dance_skeleton skeleton{};
    skeleton.struct_size = sizeof skeleton;
    while (seen < 200 + life) {
      ASSERT_LT(mono_now(), give_up) << "no pose of life " << life;
      std::uint32_t slot = 0;
      if (dance_adapter_find(adapter, "alice", &slot) != DANCE_OK) continue;
      const bool is_newest = life % 2 == 0;
      const dance_status status =
          is_newest
              ? timed([&] { return dance_adapter_newest(adapter, slot, &pose); })
              : timed([&] {
                  // Beyond the newest, and between two.
                  const std::int64_t before_ns = seen % 2 == 0 ? 0 : 20'000;
                  return dance_adapter_at(adapter, slot, dance_adapter_now_ns() - before_ns, &pose);
                });
      timed([&] { return dance_adapter_skeleton(adapter, slot, &skeleton); });
      if (status != DANCE_OK) continue;
      ++fine;
      if (!is_sound(pose)) ++unsound;
      if (is_newest && !is_whole(pose)) ++torn;
      if (pose.sequence / 1'000'000 == life) ++seen;
    }
    writer->kill_now();
    ASSERT_EQ(writer->end_signal(), SIGKILL) << "the writer could not have the memory again";
    // What it left is read too: nobody waits for a dead one.
    for (int i = 0; i < 50; ++i) {
      std::uint32_t slot = 0;
      if (timed([&] { return dance_adapter_find(adapter, "alice", &slot); }) != DANCE_OK) continue;
      if (timed([&] { return dance_adapter_newest(adapter, slot, &pose); }) == DANCE_OK &&
          !is_whole(pose))
        ++torn;
      const std::int64_t t_ns = dance_adapter_now_ns() - i * 1'000'000;
      if (timed([&] { return dance_adapter_at(adapter, slot, t_ns, &pose); }) == DANCE_OK &&
          !is_sound(pose))
        ++unsound;
    }
  }
  dance_counters counters{};
  counters.struct_size = sizeof counters;
  ASSERT_EQ(dance_adapter_counters(adapter, &counters), DANCE_OK);
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(unsound, 0u);
  EXPECT_LT(timed.longest(), kHangs) << "a call hung";
  EXPECT_EQ(counters.damaged, 0u);
  EXPECT_EQ(counters.attached, static_cast<std::uint64_t>(kLives));
  EXPECT_GE(fine, 200u * kLives);
  dance_adapter_close(adapter);
  // The name goes with one that ends by itself.
  ASSERT_TRUE(EngineConsumer::open(memory, 0.0, this_clock_id(), mono_now()));
}

}  // namespace
}  // namespace dance
