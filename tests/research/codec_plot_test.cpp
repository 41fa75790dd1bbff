// The picture of bytes over errors: a whole SVG file that shows what it was given.
#include "research/codec/codec_plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace dance {
namespace {

RatePlot some_plot() {
  RatePlot plot;
  plot.title = "bytes & errors <of a dance>";
  plot.series = {{"key frame", {{0.25, 65.0}, {1.0, 45.5}, {5.0, 30.0}}},
                 {"4 frames old", {{0.25, 40.0}, {1.0, 25.25}, {5.0, 15.0}}},
                 {"1 frame old", {{0.25, 20.0}, {1.0, 13.75}, {5.0, 8.0}}}};
  plot.marks = {{"three int16", 144.0, 3.5}, {"two thirds", 242.7, std::nullopt}};
  return plot;
}

// Every tag closed in its order, every value of an attribute between quotes, no bare & or <.
testing::AssertionResult is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < xml.size(); ++i) {
    if (xml[i] == '&') {
      const std::string entity = xml.substr(i, xml.find(';', i) - i + 1);
      if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;")
        return testing::AssertionFailure() << "a bare & at " << i;
    }
    if (xml[i] != '<') continue;
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return testing::AssertionFailure() << "a tag that does not end";
    const std::string tag = xml.substr(i + 1, end - i - 1);
    if (tag.find('<') != std::string::npos || std::count(tag.begin(), tag.end(), '"') % 2 != 0)
      return testing::AssertionFailure() << "damaged: " << tag;
    if (tag.front() == '/') {
      if (open.empty() || open.back() != tag.substr(1))
        return testing::AssertionFailure() << "closes what is not open: " << tag;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
    i = end;
  }
  if (!open.empty()) return testing::AssertionFailure() << open.back() << " stays open";
  return testing::AssertionSuccess();
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(RatePlot, IsWellFormedAndShowsEverySeries) {
  const RatePlot plot = some_plot();
  const std::string svg = rate_plot_svg(plot);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(svg.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\"", 0), 0u);
  EXPECT_EQ(count(svg, "<polyline "), plot.series.size());
  for (const RateSeries& series : plot.series) EXPECT_EQ(count(svg, '>' + series.name + '<'), 1u);
  // Nine points, one mark, three in the legend.
  EXPECT_EQ(count(svg, "<path "), 13u);
  // Sizes at 1 mm, and what is compared with.
  for (const char* text : {">45.5<", ">25.2<", ">13.8<", "three int16: 144, off by 3.5 mm",
                           "two thirds: 243", "bytes &amp; errors &lt;of a dance&gt;"})
    EXPECT_EQ(count(svg, text), 1u) << text;
  EXPECT_EQ(count(svg, "nan"), 0u);
  EXPECT_EQ(count(svg, "inf"), 0u);
}

TEST(RatePlot, MoreBytesAreHigherAndMoreErrorIsFurtherRight) {
  RatePlot plot;
  plot.series = {{"one", {{0.5, 100.0}, {2.0, 10.0}}}};
  const std::string svg = rate_plot_svg(plot);
  const std::string key = "<polyline points=\"";
  double x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
  ASSERT_EQ(
      std::sscanf(svg.c_str() + svg.find(key) + key.size(), "%lf,%lf %lf,%lf", &x1, &y1, &x2, &y2),
      4);
  EXPECT_LT(x1, x2);
  EXPECT_LT(y1, y2);  // y points down
}

TEST(RatePlot, WhatHasNoPlaceOnALogarithmicAxisIsLeftOut) {
  RatePlot plot = some_plot();
  plot.series[0].points.push_back({6.0, 0.0});
  plot.series[0].points.push_back({0.0, 10.0});
  plot.marks.push_back({"exact", 300.0, 0.0});
  const std::string svg = rate_plot_svg(plot);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(count(svg, "<path "), 13u);
  EXPECT_EQ(count(svg, "nan") + count(svg, "inf") + count(svg, "exact"), 0u);
  EXPECT_TRUE(is_well_formed(rate_plot_svg(RatePlot())));
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
  EXPECT_TRUE(is_well_formed(rate_plot_svg(plot)));
}

}  // namespace
}  // namespace dance
