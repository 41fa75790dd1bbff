#include "core/codec/quality_by_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr double kHz = 60.0;

// Poses at 60 Hz that cost what the quality makes of them.
struct Dancer {
  explicit Dancer(QualityByRate begin) : quality(begin) {}
  QualityByRate quality;
  MonoTime now = MonoTime::from_us(7'000'000);
  int changes = 0;
  MonoTime changed_at;
  Duration least_gap = Duration::s(1000);

  // bytes_at_1mm may vary with the frame.
  void dance(Duration duration, const std::function<double(int frame)>& bytes_at_1mm) {
    const MonoTime end = now + duration;
    for (int frame = 0; now < end; ++frame, now += Duration::us(16'667)) {
      // A third more for half the error: as dance codec eval has it.
      const double finer = std::log2(0.001 / quality.quality_m());
      const double bytes = bytes_at_1mm(frame) * std::pow(1.33, finer);
      const double before = quality.quality_m();
      const bool said = quality.add(static_cast<std::size_t>(std::lround(bytes)), now);
      ASSERT_EQ(said, quality.quality_m() != before);
      if (!said) continue;
      ++changes;
      if (changed_at.is_set()) least_gap = std::min(least_gap, now - changed_at);
      changed_at = now;
    }
  }
  void dance(Duration duration, double bytes_at_1mm) {
    dance(duration, [&](int) { return bytes_at_1mm; });
  }
};

TEST(QualityByRate, WithoutARateStaysWhereItBegins) {
  Dancer dancer{QualityByRate(0.003, 0.0)};
  dancer.dance(Duration::s(20), 400.0);
  EXPECT_EQ(dancer.quality.quality_m(), 0.003);
  EXPECT_EQ(dancer.changes, 0);
}

TEST(QualityByRate, KeepsTheFinestWhereThatFits) {
  Dancer dancer{QualityByRate(0.001, 1300.0)};
  dancer.dance(Duration::s(60), 20.0);
  EXPECT_EQ(dancer.quality.quality_m(), 0.001);
  EXPECT_EQ(dancer.changes, 0);
}

TEST(QualityByRate, GetsCoarserUntilItFits) {
  Dancer dancer{QualityByRate(0.001, 1000.0)};
  dancer.dance(Duration::s(3), 20.0);
  EXPECT_EQ(dancer.quality.quality_m(), 0.002);
  Dancer far{QualityByRate(0.0005, 700.0)};
  far.dance(Duration::s(6), 20.0);
  EXPECT_EQ(far.quality.quality_m(), 0.005);
  EXPECT_EQ(far.changes, 3);
}

TEST(QualityByRate, EndsAtTheCoarsestWhateverItCosts) {
  Dancer dancer{QualityByRate(0.001, 10.0)};
  dancer.dance(Duration::s(30), 20.0);
  EXPECT_EQ(dancer.quality.quality_m(), 0.005);
  EXPECT_EQ(dancer.changes, 2);
}

TEST(QualityByRate, IsNeverFinerThanItBegan) {
  Dancer dancer{QualityByRate(0.002, 1000.0)};
  dancer.dance(Duration::s(30), 2.0);
  EXPECT_EQ(dancer.quality.quality_m(), 0.002);
  // Between the steps, and beyond all of them.
  Dancer between{QualityByRate(0.003, 10.0)};
  between.dance(Duration::s(10), 20.0);
  EXPECT_EQ(between.quality.quality_m(), 0.005);
  Dancer beyond{QualityByRate(0.010, 10.0)};
  beyond.dance(Duration::s(10), 20.0);
  EXPECT_EQ(beyond.quality.quality_m(), 0.010);
}

TEST(QualityByRate, ComesBackWhenTheDanceIsCalmer) {
  Dancer dancer{QualityByRate(0.001, 1000.0)};
  dancer.dance(Duration::s(5), 28.0);
  EXPECT_GT(dancer.quality.quality_m(), 0.001);
  dancer.dance(Duration::s(10), 10.0);
  EXPECT_EQ(dancer.quality.quality_m(), 0.001);
}

TEST(QualityByRate, DoesNotFlutterWhateverTheDance) {
  Random random(3);
  for (double bytes = 8.0; bytes < 60.0; bytes += 1.0) {
    Dancer dancer{QualityByRate(0.0005, 1000.0)};
    dancer.dance(Duration::s(60), [&](int frame) {
      const double key = frame % 120 == 0 ? 60.0 : 0.0;
      return bytes * (0.7 + 0.6 * random.uniform()) + key;
    });
    EXPECT_LE(dancer.changes, 4) << bytes;
    EXPECT_GE(dancer.least_gap, Duration::s(1)) << bytes;
  }
}

// Wild and calm by turns is the worst case: each try that failed makes the next one wait longer.
TEST(QualityByRate, TriesLessOftenWhatHasFailed) {
  Dancer dancer{QualityByRate(0.001, 1000.0)};
  dancer.dance(Duration::s(300), [](int frame) {
    const double at_s = frame / kHz;
    return std::fmod(at_s, 6.0) < 4.5 ? 10.0 : 26.0;
  });
  EXPECT_LE(dancer.changes, 80);
  EXPECT_GE(dancer.least_gap, Duration::s(1));
}

TEST(QualityByRate, APauseIsNoReasonForAnything) {
  Dancer dancer{QualityByRate(0.001, 1000.0)};
  dancer.dance(Duration::s(5), 20.0);
  ASSERT_EQ(dancer.quality.quality_m(), 0.002);
  const int before = dancer.changes;
  for (int i = 0; i < 10; ++i) {
    dancer.now += Duration::s(10);
    dancer.dance(Duration::ms(400), 20.0);
  }
  EXPECT_EQ(dancer.changes, before);
  EXPECT_EQ(dancer.quality.quality_m(), 0.002);
}

}  // namespace
}  // namespace dance
