#include "research/codec/codec_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/codec/lossless/lossless_codec.h"
#include "core/program/whole_file.h"
#include "research/outside_program.h"
#include "testing/scratch_folder.h"

namespace dance {

RatePlot measure_rates(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                       const CodecEval& eval) {
  RatePlot plot;
  plot.title =
      fmt::format("Pose codec: {} frames of dance at {:.0f} a second", eval.frames, eval.hz);
  for (const std::uint32_t age : {0u, 4u, 2u, 1u}) {
    RateSeries series;
    series.name = age == 0   ? "intra frame"
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

std::string rate_plot_script(const RatePlot& plot) {
  std::string data, labels, curves;
  double least = 1e9, most = 0.0;
  const auto include = [&](double bytes) {
    least = std::min(least, bytes);
    most = std::max(most, bytes);
  };
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    data += fmt::format("$series{} << END\n", i);
    for (const RatePoint& p : plot.series[i].points) {
      if (!(p.error_mm > 0.0 && p.bytes > 0.0)) continue;
      include(p.bytes);
      data += fmt::format("{:g} {:.2f}\n", p.error_mm, p.bytes);
      // The size at 1 mm is written beside its point.
      if (p.error_mm == 1.0)
        labels += fmt::format("set label \"{0:.1f}\" at 1,{0:g} offset 0.9,0.6\n", p.bytes);
    }
    data += "END\n";
    curves += fmt::format("{}$series{} with linespoints lw 2 pt {} title \"{}\"", i > 0 ? ", " : "",
                          i, 5 + 2 * i, plot.series[i].name);
  }
  for (const RateMark& mark : plot.marks) {
    if (!(mark.bytes > 0.0) || !(mark.error_mm.value_or(1.0) > 0.0)) continue;
    include(mark.bytes);
    curves += mark.error_mm ? fmt::format(", \"+\" using ({:g}):({:g}) with points pt 2 lc black",
                                          *mark.error_mm, mark.bytes)
                            : fmt::format(", {:g} with lines dt 2 lc black", mark.bytes);
    curves += fmt::format(" title \"{}: {:.0f}\"", mark.name, mark.bytes);
  }
  return fmt::format(
             "set terminal svg size 790,440 noenhanced font \"sans-serif,13\" background "
             "\"white\"\n"
             "set title \"{}\"\n"
             "set xlabel \"largest error of any joint or tip, mm\"\n"
             "set ylabel \"bytes a frame, mean\"\n"
             "set logscale xy\nset grid\nset border 3\nset tics nomirror\n"
             "set key outside right top Left reverse title \"reference\"\n"
             "set xtics (0.1, 0.2, 0.5, 1, 2, 5, 10, 20)\n"
             "set ytics (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)\n"
             "set xrange [0.2:6.5]\nset yrange [{:g}:{:g}]\n",
             plot.title, least / 1.4, most * 1.4) +
         data + labels + "plot " + curves + "\n";
}

Result<void> draw_rate_plot(const RatePlot& plot, const std::string& svg_file) {
  DANCE_TRY(const auto scratch, ScratchFolder::make());
  const std::string script = scratch->file("plot");
  if (auto ok = write_whole_file(script, rate_plot_script(plot)); !ok) return ok;
  // What is there would be written on.
  std::error_code none;
  std::filesystem::remove(svg_file, none);
  return run_outside_program({.name = "gnuplot",
                              .package = "gnuplot-nox",
                              .arguments = {script},
                              .output_file = svg_file,
                              .talk_file = scratch->file("talk")});
}

}  // namespace dance
