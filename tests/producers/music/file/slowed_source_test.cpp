#include "producers/music/file/slowed_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

namespace dance {
namespace {

constexpr double kSource_hz = 16000.0;

// Music that is a function of its second; counts how often it was not read on from where it was.
class FunctionSource : public MusicSource {
 public:
  FunctionSource(std::function<double(double)> sound, int& jumps)
      : sound_(std::move(sound)), jumps_(jumps) {}
  double rate_hz() const override { return kSource_hz; }
  Result<void> read(std::int64_t frame, std::span<float> interleaved) override {
    if (at_ && *at_ != frame) ++jumps_;
    for (std::size_t i = 0; i < interleaved.size(); ++i)
      interleaved[i] = static_cast<float>(
          sound_(static_cast<double>(frame + static_cast<std::int64_t>(i / 2)) / kSource_hz));
    at_ = frame + static_cast<std::int64_t>(interleaved.size() / 2);
    return {};
  }

 private:
  std::function<double(double)> sound_;
  int& jumps_;
  std::optional<std::int64_t> at_;
};

double sine(double s) { return 0.5 * std::sin(2.0 * std::numbers::pi * 330.0 * s); }

class SlowedSourceTest : public testing::Test {
 protected:
  // The left channel of the music at that speed, as a player reads it.
  std::vector<float> heard(const std::function<double(double)>& sound, double speed,
                           double length_s) {
    SlowedSource source(std::make_unique<FunctionSource>(sound, jumps_));
    source.set_speed(speed);
    std::vector<float> left;
    std::vector<float> block(2 * 1000);
    std::int64_t frame = 0;
    while (static_cast<double>(frame) < length_s * kSource_hz) {
      EXPECT_TRUE(source.read(frame, block));
      for (std::size_t i = 0; i < block.size(); i += 2) left.push_back(block[i]);
      frame += static_cast<std::int64_t>(block.size() / 2);
    }
    return left;
  }
  int jumps_ = 0;
};

TEST_F(SlowedSourceTest, KeepsThePitchAndTheLoudnessOfATone) {
  for (const double speed : {0.5, 0.75, 0.9, 1.1}) {
    const std::vector<float> left = heard(sine, speed, 3.0);
    int crossings = 0;
    double energy = 0.0;
    const std::size_t from = left.size() / 6, to = 5 * left.size() / 6;
    for (std::size_t i = from; i < to; ++i) {
      crossings += left[i - 1] < 0.0f && left[i] >= 0.0f ? 1 : 0;
      energy += static_cast<double>(left[i]) * static_cast<double>(left[i]);
    }
    const double seconds = static_cast<double>(to - from) / kSource_hz;
    EXPECT_NEAR(crossings / seconds, 330.0, 3.0) << speed;
    EXPECT_NEAR(std::sqrt(2.0 * energy / static_cast<double>(to - from)), 0.5, 0.03) << speed;
  }
  EXPECT_EQ(jumps_, 0) << "the file is read on, never back";
}

TEST_F(SlowedSourceTest, IsInTimeAtEachSpeed) {
  // A tone of 60 ms in each half second, from its quarter on.
  const auto bursts = [](double s) {
    const double at = s - 0.5 * std::floor(2.0 * s);
    return at >= 0.25 && at < 0.31 ? sine(s) : 0.0;
  };
  for (const double speed : {0.5, 0.8, 1.1}) {
    const std::vector<float> left = heard(bursts, speed, 6.0);
    for (int k = 0; k < 5; ++k) {
      const double middle_s = (0.5 * k + 0.28) / speed, reach_s = 0.2 / speed;
      double weight = 0.0, moment = 0.0;
      for (auto i = static_cast<std::size_t>((middle_s - reach_s) * kSource_hz);
           i < static_cast<std::size_t>((middle_s + reach_s) * kSource_hz); ++i) {
        const double power = static_cast<double>(left[i]) * static_cast<double>(left[i]);
        weight += power;
        moment += power * static_cast<double>(i) / kSource_hz;
      }
      ASSERT_GT(weight, 0.0) << speed << " " << k;
      EXPECT_NEAR(moment / weight, middle_s, SlowedSource::kSearch_s + 0.004) << speed << " " << k;
    }
  }
}

TEST_F(SlowedSourceTest, IsTheMusicItselfAtItsOwnSpeedAndWithinItsBounds) {
  const std::vector<float> own = heard(sine, 1.0, 0.5);
  for (std::size_t i = 0; i < own.size(); ++i)
    ASSERT_EQ(own[i], static_cast<float>(sine(static_cast<double>(i) / kSource_hz))) << i;
  EXPECT_EQ(heard(sine, 0.01, 0.5), heard(sine, 0.5, 0.5));
  EXPECT_EQ(heard(sine, 9.0, 0.5), heard(sine, 1.1, 0.5));
}

}  // namespace
}  // namespace dance
