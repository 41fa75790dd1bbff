#include "apps/demo/sway_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/overlay/plot_canvas.h"
#include "viewer/scene/beat_words.h"

namespace dance {
namespace {

using Anchor = PlotCanvas::Anchor;
using Size = PlotCanvas::Size;

constexpr int kWidth_px = 1200, kHeight_px = 780;
constexpr double kLeft = 74.0, kRight = kWidth_px - 24.0;
constexpr double kTop = 82.0, kRowHeight = 176.0, kBetweenRows = 42.0;
constexpr int kRows = 3;

constexpr std::uint32_t kInk = 0x222222, kFaint = 0x6a6a6a, kGrid = 0xd9d9d9, kOne = 0x8a8a8a;
// Distinct under colour blindness too. Source: Okabe and Ito, 2008.
constexpr std::uint32_t kHere = 0x009e73, kDanced = 0xa8a8a8, kRaw = 0xd55e00, kShown = 0x0072b2;

class SwayDrawing {
 public:
  SwayDrawing(PlotCanvas& canvas, const SwayPlot& plot) : canvas_(canvas), plot_(plot) {
    first_ = std::floor(plot.lines.here.beats.front());
    last_ = std::ceil(plot.lines.here.beats.back());
    for (const SwayLine* line :
         {&plot.lines.here, &plot.lines.danced, &plot.lines.raw, &plot.lines.shown})
      for (const double cm : line->sway_cm) most_cm_ = std::max(most_cm_, std::abs(cm));
    most_cm_ = 2.0 * std::ceil(0.5 * most_cm_ + 0.2);
  }

  void draw() {
    canvas_.text({kLeft, 24.0},
                 fmt::format("Hip sway on the beat: {} dances here, {} in another house",
                             plot_.here, plot_.remote),
                 kInk, Anchor::kLeft, Size::kTitle);
    row(0, fmt::format("{}, here", plot_.here));
    curve(0, plot_.lines.here, kHere, 2.4);
    row(1, fmt::format("{} as the poses come", plot_.remote));
    curve(1, plot_.lines.danced, kDanced, 3.4);
    curve(1, plot_.lines.raw, kRaw, 2.2);
    figures(1, plot_.rhythm.raw, kRaw);
    row(2, fmt::format("{} as the stage shows the dance", plot_.remote));
    curve(2, plot_.lines.danced, kDanced, 3.4);
    curve(2, plot_.lines.shown, kShown, 2.2);
    figures(2, plot_.rhythm.shown, kShown);
    canvas_.text({0.5 * (kLeft + kRight), row_bottom(kRows - 1) + 44.0},
                 fmt::format("count of the music in house A ({:.0f} beats a minute: {:.0f} ms each)"
                             "     grey: as danced, on the beat     up: to the dancer's left",
                             plot_.rhythm.tempo_bpm, 60e3 / plot_.rhythm.tempo_bpm),
                 kInk, Anchor::kMiddle);
  }

 private:
  static double row_top(int r) { return kTop + r * (kRowHeight + kBetweenRows); }
  static double row_bottom(int r) { return row_top(r) + kRowHeight; }
  double x_of(double beats) const {
    return kLeft + (kRight - kLeft) * (beats - first_) / (last_ - first_);
  }
  double y_of(int r, double cm) const {
    return row_top(r) + kRowHeight * 0.5 * (1.0 - cm / most_cm_);
  }

  void row(int r, const std::string& title) {
    for (double beat = first_; beat <= last_; beat += 1.0) {
      const bool is_one = std::fmod(std::fmod(beat, 8.0) + 8.0, 8.0) == 0.0;
      canvas_.line({x_of(beat), row_top(r)}, {x_of(beat), row_bottom(r)}, is_one ? kOne : kGrid,
                   is_one ? 2.0 : 1.0);
      if (r != kRows - 1) continue;
      const int count = static_cast<int>(std::fmod(std::fmod(beat, 8.0) + 8.0, 8.0)) + 1;
      canvas_.text({x_of(beat), row_bottom(r) + 18.0}, std::to_string(count),
                   is_one ? kInk : kFaint, Anchor::kMiddle);
    }
    for (const double cm : {-most_cm_, 0.0, most_cm_}) {
      canvas_.line({kLeft, y_of(r, cm)}, {kRight, y_of(r, cm)}, kGrid, 1.0);
      canvas_.text({kLeft - 8.0, y_of(r, cm)}, fmt::format("{:.0f}", cm), kFaint, Anchor::kRight);
    }
    canvas_.text({kLeft - 8.0, row_top(r) - 19.0}, "cm", kFaint, Anchor::kRight);
    canvas_.text({kLeft, row_top(r) - 19.0}, title, kInk);
  }

  void curve(int r, const SwayLine& line, std::uint32_t colour, double width) {
    std::vector<PlotPoint> points;
    for (std::size_t i = 0; i < line.beats.size(); ++i)
      points.push_back({x_of(line.beats[i]), y_of(r, line.sway_cm[i])});
    canvas_.clip({kLeft, row_top(r)}, {kRight, row_bottom(r)});
    canvas_.curve(points, colour, width);
    canvas_.end_clip();
  }

  void figures(int r, const StageFigures& f, std::uint32_t colour) {
    const std::string seen = is_predicted(f.content_delay_ms, plot_.rhythm.raw.content_delay_ms)
                                 ? "is " + prediction_words(f.content_delay_ms)
                                 : fmt::format("was danced {:.0f} ms before", f.content_delay_ms);
    canvas_.text({kRight, row_top(r) - 19.0},
                 fmt::format("{}, \u00b1 {:.0f} ms;  what is seen {}", beat_words(f.phase_mean_ms),
                             f.phase_sd_ms, seen),
                 colour, Anchor::kRight);
  }

  PlotCanvas& canvas_;
  const SwayPlot& plot_;
  double first_ = 0.0, last_ = 1.0, most_cm_ = 2.0;
};

}  // namespace

Result<void> write_sway_plot(const std::string& file, const SwayPlot& plot) {
  if (plot.lines.here.beats.size() < 2)
    return fail(file + ": nothing was danced that it could show");
  DANCE_TRY(auto canvas, PlotCanvas::create(kWidth_px, kHeight_px));
  SwayDrawing(*canvas, plot).draw();
  DANCE_TRY(const Picture picture, canvas->finish());
  return write_png(file, picture);
}

}  // namespace dance
