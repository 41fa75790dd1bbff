#include "research/codec/codec_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/codec/lossless_codec.h"

namespace dance {
namespace {

constexpr double kWidth = 790.0, kHeight = 440.0;
constexpr double kLeft = 66.0, kRight = 604.0, kTop = 48.0, kBottom = 378.0;
constexpr double kLegendLeft = kRight + 22.0;

// Told apart without colours too, and by those who see fewer of them. Source: Okabe and Ito, 2008.
struct LineStyle {
  const char* colour;
  const char* dot;  // around 0, 0
};
constexpr std::array<LineStyle, 4> kStyles{
    {{"#d55e00", "M-4.5 0L0 -5.5L4.5 0L0 5.5Z"},
     {"#009e73", "M-5 4L0 -5.5L5 4Z"},
     {"#0072b2", "M-4 -4H4V4H-4Z"},
     {"#aa3377", "M-4.5 0A4.5 4.5 0 1 1 4.5 0A4.5 4.5 0 1 1 -4.5 0Z"}}};
constexpr LineStyle kMarkStyle{"#333333", "M-5 -5L5 5M-5 5L5 -5"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  return out;
}

class LogAxis {
 public:
  LogAxis(double at_low, double at_high) : at_low_(at_low), at_high_(at_high) {}

  void include(double value) {
    if (!(value > 0.0)) return;
    low_ = is_empty_ ? value : std::min(low_, value);
    high_ = is_empty_ ? value : std::max(high_, value);
    is_empty_ = false;
  }
  // Some room at both ends.
  void widen(double factor) {
    if (is_empty_) low_ = high_ = 1.0;
    low_ /= factor;
    high_ *= factor;
  }
  double at(double value) const {
    const double part = std::log(value / low_) / std::log(high_ / low_);
    return at_low_ + part * (at_high_ - at_low_);
  }
  // 1, 2 and 5 of each power of ten.
  std::vector<double> ticks() const {
    std::vector<double> all;
    for (double decade = std::pow(10.0, std::floor(std::log10(low_))); decade <= high_;
         decade *= 10.0)
      for (const double first : {1.0, 2.0, 5.0})
        if (first * decade >= low_ && first * decade <= high_) all.push_back(first * decade);
    return all;
  }

 private:
  double at_low_, at_high_;
  bool is_empty_ = true;
  double low_ = 1.0, high_ = 1.0;
};

class Drawing {
 public:
  void line(double x1, double y1, double x2, double y2, const char* look) {
    out_ += fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" {}/>)", x1, y1, x2,
                        y2, look) +
            "\n";
  }
  void text(double x, double y, const std::string& what, const std::string& look = "") {
    out_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}"{}{}>{}</text>)", x, y,
                        look.empty() ? "" : " ", look, escaped(what)) +
            "\n";
  }
  void dot(double x, double y, const LineStyle& style) {
    out_ += fmt::format(
                R"svg(<path transform="translate({:.1f} {:.1f})" d="{}" fill="{}" stroke="{}")svg",
                x, y, style.dot, style.colour, style.colour) +
            R"( stroke-width="2"/>)" + "\n";
  }
  void path(const std::string& points, const LineStyle& style) {
    out_ += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="2.2"/>)",
                        points, style.colour) +
            "\n";
  }
  std::string whole() const {
    return fmt::format(
               R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" )"
               R"(viewBox="0 0 {0:.0f} {1:.0f}" font-family="sans-serif" )"
               R"(font-size="13" fill="#222">)",
               kWidth, kHeight) +
           "\n" + R"(<rect width="100%" height="100%" fill="#fff"/>)" + "\n" + out_ + "</svg>\n";
  }

 private:
  std::string out_;
};

constexpr const char* kGrid = R"(stroke="#e2e2e2")";
constexpr const char* kFrame = R"(stroke="#777")";
constexpr const char* kLevelLine = R"(stroke="#333" stroke-dasharray="6 4")";

void draw_axes(Drawing& svg, const LogAxis& x, const LogAxis& y) {
  for (const double tick : x.ticks()) {
    svg.line(x.at(tick), kTop, x.at(tick), kBottom, kGrid);
    svg.text(x.at(tick), kBottom + 19.0, fmt::format("{:g}", tick), R"(text-anchor="middle")");
  }
  for (const double tick : y.ticks()) {
    svg.line(kLeft, y.at(tick), kRight, y.at(tick), kGrid);
    svg.text(kLeft - 8.0, y.at(tick) + 4.5, fmt::format("{:g}", tick), R"(text-anchor="end")");
  }
  svg.line(kLeft, kBottom, kRight, kBottom, kFrame);
  svg.line(kLeft, kTop, kLeft, kBottom, kFrame);
  svg.text((kLeft + kRight) / 2.0, kBottom + 43.0, "largest error of any joint or tip, mm",
           R"(text-anchor="middle")");
  const double middle = (kTop + kBottom) / 2.0;
  svg.text(18.0, middle, "bytes a frame, mean",
           fmt::format(R"svg(text-anchor="middle" transform="rotate(-90 18 {:.1f})")svg", middle));
}

// The size at 1 mm is written beside its dot.
void draw_series(Drawing& svg, const RateSeries& series, const LineStyle& style, const LogAxis& x,
                 const LogAxis& y) {
  std::string points;
  for (const RatePoint& p : series.points)
    if (p.error_mm > 0.0 && p.bytes > 0.0)
      points += fmt::format("{:.1f},{:.1f} ", x.at(p.error_mm), y.at(p.bytes));
  svg.path(points, style);
  for (const RatePoint& p : series.points) {
    if (!(p.error_mm > 0.0 && p.bytes > 0.0)) continue;
    svg.dot(x.at(p.error_mm), y.at(p.bytes), style);
    if (p.error_mm == 1.0)
      svg.text(x.at(p.error_mm) + 9.0, y.at(p.bytes) - 7.0, fmt::format("{:.1f}", p.bytes),
               fmt::format(R"(fill="{}" font-weight="bold")", style.colour));
  }
}

void draw_mark(Drawing& svg, const RateMark& mark, const LogAxis& x, const LogAxis& y) {
  if (!(mark.bytes > 0.0)) return;
  const double at = y.at(mark.bytes);
  if (!mark.error_mm) {
    svg.line(kLeft, at, kRight, at, kLevelLine);
    svg.text(kLeft + 8.0, at - 7.0, fmt::format("{}: {:.0f}", mark.name, mark.bytes));
    return;
  }
  if (!(*mark.error_mm > 0.0)) return;
  const double across = x.at(*mark.error_mm);
  svg.dot(across, at, kMarkStyle);
  const bool is_right = across > (kLeft + kRight) / 2.0;
  svg.text(across + (is_right ? -11.0 : 11.0), at + 4.5,
           fmt::format("{}: {:.0f}, off by {:.1f} mm", mark.name, mark.bytes, *mark.error_mm),
           is_right ? R"(text-anchor="end")" : "");
}

}  // namespace

RatePlot measure_rates(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                       const CodecEval& eval) {
  RatePlot plot;
  plot.title =
      fmt::format("Pose codec: {} frames of dance at {:.0f} a second", eval.frames, eval.hz);
  for (const std::uint32_t age : {0u, 4u, 2u, 1u}) {
    RateSeries series;
    series.name = age == 0   ? "none (key frame)"
                  : age == 1 ? "1 frame old"
                             : fmt::format("{} frames old", age);
    for (const double error_mm : kPlotErrors_mm) {
      CodecEvalOptions at = options;
      at.error_m = error_mm * 1e-3;
      series.points.push_back({error_mm, mean_bytes_of(takes, at, age)});
    }
    plot.series.push_back(std::move(series));
  }
  plot.marks.push_back(
      {"three int16 a bone", eval.three_int16_bytes, eval.three_int16_errors.max_position_m * 1e3});
  plot.marks.push_back({"two thirds of raw floats", kRawPose_bytes * 2.0 / 3.0, std::nullopt});
  return plot;
}

std::string rate_plot_svg(const RatePlot& plot) {
  LogAxis x(kLeft, kRight), y(kBottom, kTop);
  for (const RateSeries& series : plot.series)
    for (const RatePoint& p : series.points) {
      x.include(p.error_mm);
      y.include(p.bytes);
    }
  for (const RateMark& mark : plot.marks) {
    x.include(mark.error_mm.value_or(0.0));
    y.include(mark.bytes);
  }
  x.widen(1.25);
  y.widen(1.4);
  Drawing svg;
  svg.text(kLeft, 26.0, plot.title, R"(font-size="15" font-weight="bold")");
  draw_axes(svg, x, y);
  for (const RateMark& mark : plot.marks) draw_mark(svg, mark, x, y);
  double legend_y = kTop + 12.0;
  svg.text(kLegendLeft, legend_y, "reference", R"(fill="#555")");
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const LineStyle& style = kStyles[i % kStyles.size()];
    draw_series(svg, plot.series[i], style, x, y);
    legend_y += 26.0;
    svg.line(kLegendLeft, legend_y - 4.5, kLegendLeft + 30.0, legend_y - 4.5,
             fmt::format(R"(stroke="{}" stroke-width="2.2")", style.colour).c_str());
    svg.dot(kLegendLeft + 15.0, legend_y - 4.5, style);
    svg.text(kLegendLeft + 40.0, legend_y, plot.series[i].name);
  }
  return svg.whole();
}

}  // namespace dance
