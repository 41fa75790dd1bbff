#include "research/codec/codec_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

RatePlot some_plot() {
  RatePlot plot;
  plot.title = "bytes of a dance";
  plot.series = {{"intra frame", {{0.25, 65.0}, {1.0, 45.5}, {5.0, 30.0}}},
                 {"4 frames old", {{0.25, 40.0}, {1.0, 25.25}, {5.0, 15.0}}},
                 {"1 frame old", {{0.25, 20.0}, {1.0, 13.75}, {5.0, 8.0}}}};
  plot.marks = {{"three int16", 144.0, 3.5}, {"two thirds", 242.7, std::nullopt}};
  return plot;
}

bool has(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

TEST(RatePlot, TellsGnuplotEveryPointThatHasAPlaceOnALogarithmicAxis) {
  RatePlot plot = some_plot();
  plot.series[0].points.push_back({6.0, 0.0});
  plot.series[0].points.push_back({0.0, 10.0});
  plot.marks.push_back({"exact", 300.0, 0.0});
  const std::string script = rate_plot_script(plot);
  for (const char* text :
       {"0.25 65.00\n1 45.50\n5 30.00\nEND", "4 frames old", "three int16", "242.7 with lines"})
    EXPECT_TRUE(has(script, text)) << text << " in " << script;
  EXPECT_FALSE(has(script, "exact"));
}

TEST(RatePlot, IsDrawnByGnuplot) {
  const TestFolder folder("rate-plot");
  const auto drawn = draw_rate_plot(some_plot(), folder.path("plot.svg"));
  if (!drawn && has(drawn.error().what, "apt-get install")) GTEST_SKIP() << drawn.error().what;
  ASSERT_TRUE(drawn) << drawn.error().what;
  const std::string svg = text_of(folder.path("plot.svg"));
  for (const char* text : {"<svg", "intra frame", "4 frames old", "1 frame old", ">45.5<", ">25.2<",
                           ">13.8<", "three int16", "two thirds", "bytes of a dance"})
    EXPECT_TRUE(has(svg, text)) << text;
}

TEST(RatePlot, OfADanceCostsLessTheMoreErrorIsAllowedAndTheNearerTheReference) {
  CodecTake take;
  take.skeleton = average_skeleton();
  for (std::uint32_t i = 0; i < 60; ++i) {
    Pose pose;
    pose.sequence = i;
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + i / 60.0);
    pose.p_WH_m = {0.0f, 0.95f, 0.1f * std::sin(0.1f * static_cast<float>(i))};
    for (std::size_t b = 0; b < kBoneCount; ++b)
      pose.R_PB[b] =
          Eigen::AngleAxisf(0.4f * std::sin(0.1f * static_cast<float>(i) + static_cast<float>(b)),
                            Eigen::Vector3f(1.0f, 0.5f, static_cast<float>(b)).normalized());
    take.poses.push_back(pose);
  }
  CodecEvalOptions options;
  options.model = generic_model();
  const std::vector<CodecTake> takes{take};
  const RatePlot plot = measure_rates(takes, options, evaluate_codec(takes, options));
  ASSERT_EQ(plot.series.size(), 4u);
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const auto& points = plot.series[s].points;
    ASSERT_EQ(points.size(), kPlotErrors_mm.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_GT(points[i].bytes, 0.0);
      if (i > 0) {
        EXPECT_LT(points[i].bytes, points[i - 1].bytes) << plot.series[s].name;
      }
      if (s > 0) {
        EXPECT_LT(points[i].bytes, plot.series[s - 1].points[i].bytes);
      }
    }
  }
}

}  // namespace
}  // namespace dance
