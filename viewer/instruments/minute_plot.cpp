#include "viewer/instruments/minute_plot.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr ImU32 kLine = ink_of(0x6fb7ff);
constexpr ImU32 kSecondLine = ink_of(0xf0b43c);

// The next of 1, 2, 5, 10 …: axes that do not change with each second.
float round_up(float value) {
  const float decade = std::pow(10.0f, std::floor(std::log10(std::max(value, 1e-3f))));
  for (const float step : {1.0f, 2.0f, 5.0f})
    if (value <= step * decade * 1.0001f) return step * decade;
  return 10.0f * decade;
}

struct Axis {
  float low, high;
};

Axis axis_of(const MinutePlot& plot, const GuestRecord& record) {
  float most = plot.least_range, least = 0.0f;
  for (std::size_t i = 0; i < record.size(); ++i) {
    for (const auto figure : {plot.figure, plot.second}) {
      const float value = figure != nullptr ? figure(record.at(i)) : 0.0f;
      if (!std::isfinite(value)) continue;
      most = std::max(most, value);
      least = std::min(least, value);
    }
  }
  const float high = round_up(plot.is_signed ? std::max(most, -least) : most);
  return {plot.is_signed ? -high : 0.0f, high};
}

void draw_line(const PanelInk& ink, float (*figure)(const GuestStats&), const GuestRecord& record,
               const BarBox& box, const Axis& axis, ImU32 colour, float width) {
  const float step = (box.right - box.left) / static_cast<float>(GuestRecord::kSeconds - 1);
  const auto y_of = [&](float value) {
    const float share =
        (std::clamp(value, axis.low, axis.high) - axis.low) / (axis.high - axis.low);
    return box.bottom - share * (box.bottom - box.top);
  };
  ImVec2 last;
  bool has_last = false;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const float value = figure(record.at(i));
    const bool is_known = std::isfinite(value);
    if (is_known) {
      const ImVec2 point(box.right - step * static_cast<float>(record.size() - 1 - i), y_of(value));
      if (has_last)
        ink.list().AddLine(last, point, colour, width);
      else
        ink.list().AddCircleFilled(point, width, colour, 8);
      last = point;
    }
    has_last = is_known;
  }
}

}  // namespace

void draw_minute_plot(const PanelInk& ink, const MinutePlot& plot, const GuestRecord& record,
                      const BarBox& box) {
  const float em = ink.em();
  ink.left(box.left, box.top, kBright, plot.title);
  if (record.size() > 0)
    ink.number(box.right, box.top, kLine, plot.format, plot.figure(record.newest()));
  const BarBox field{box.left, box.top + 1.35f * em, box.right, box.bottom};
  if (field.bottom - field.top < 2.0f * em) return;
  const Axis axis = axis_of(plot, record);
  ink.list().AddRectFilled({field.left, field.top}, {field.right, field.bottom},
                           ink_of(0xffffff, 12));
  const float zero = plot.is_signed ? 0.5f * (field.top + field.bottom) : field.bottom;
  ink.list().AddLine({field.left, zero}, {field.right, zero}, kFaint, 1.0f);
  if (plot.second != nullptr) draw_line(ink, plot.second, record, field, axis, kSecondLine, 1.0f);
  draw_line(ink, plot.figure, record, field, axis, kLine, 1.6f);
  char words[24];
  std::snprintf(words, sizeof words, "%g", static_cast<double>(axis.high));
  ink.left(field.left + 0.25f * em, field.top + 0.05f * em, kDim, words);
  if (plot.second != nullptr)
    ink.right(field.right - 0.25f * em, field.top + 0.05f * em, kSecondLine, plot.second_words);
  if (plot.is_signed) {
    std::snprintf(words, sizeof words, "%g", static_cast<double>(axis.low));
    ink.left(field.left + 0.25f * em, field.bottom - 1.2f * em, kDim, words);
  }
}

}  // namespace dance
