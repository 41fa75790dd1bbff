#include "viewer/instruments/instrument_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

#include "viewer/instruments/latency_bar.h"
#include "viewer/instruments/minute_plot.h"

namespace dance {
namespace {

constexpr std::array<KeyHelp, 2> kKeys{{{"I", Text::kDoDelays}, {"Tab", Text::kDoNextGuest}}};

// The numbers beside the bar; widths in letters' heights.
struct Column {
  const char* head;
  const char* unit;
  const char* format;
  float (*figure)(const GuestStats&);
  float width_em;
};
using S = GuestStats;
constexpr std::array<Column, 11> kColumns{{
    {"way", "ms", "%.0f", [](const S& s) { return s.newest_p50_ms; }, 3.0f},
    {"p99", "ms", "%.0f", [](const S& s) { return s.newest_p99_ms; }, 3.0f},
    {"age", "ms", "%.0f", [](const S& s) { return s.age_p50_ms; }, 3.0f},
    {"jitter", "ms", "%.1f", [](const S& s) { return s.jitter_ms; }, 3.2f},
    {"loss", "%", "%.1f", [](const S& s) { return s.loss_percent; }, 3.0f},
    {"taken", "B/s", "%.0f", [](const S& s) { return s.bytes_per_second; }, 3.6f},
    {"a pose", "B", "%.0f", [](const S& s) { return s.bytes_per_pose; }, 3.4f},
    {"ahead", "ms", "%.0f", [](const S& s) { return s.horizon_p50_ms; }, 3.4f},
    {"wrong", "mm", "%.0f", [](const S& s) { return s.error_mean_mm; }, 3.4f},
    {"hips", "mm", "%.0f", [](const S& s) { return s.hips_error_mm; }, 2.8f},
    {"beat", "ms", "%+.0f", [](const S& s) { return s.beat_ms; }, 3.2f},
}};

constexpr std::array<MinutePlot, 8> kPlots{{
    {"way to the screen", "%.0f ms", [](const S& s) { return s.newest_p50_ms; },
     [](const S& s) { return s.newest_p99_ms; }, "p99", 50.0f},
    {"age as shown", "%.0f ms", [](const S& s) { return s.age_p50_ms; },
     [](const S& s) { return s.age_p99_ms; }, "p99", 20.0f, true},
    {"jitter", "%.1f ms", [](const S& s) { return s.jitter_ms; }, nullptr, "", 5.0f},
    {"loss", "%.1f %%", [](const S& s) { return s.loss_percent; }, nullptr, "", 2.0f},
    {"tunnel", "%.0f B/s", [](const S& s) { return s.bytes_per_second; }, nullptr, "", 1000.0f},
    {"ahead of arrival", "%.0f ms", [](const S& s) { return s.horizon_p50_ms; },
     [](const S& s) { return s.horizon_p99_ms; }, "p99", 50.0f, true},
    {"prediction error", "%.0f mm", [](const S& s) { return s.error_mean_mm; },
     [](const S& s) { return s.error_p95_mm; }, "p95", 20.0f},
    {"behind the beat", "%+.0f ms", [](const S& s) { return s.beat_ms; }, nullptr, "", 50.0f, true},
}};

constexpr float kMost_px = 1e5f;
constexpr std::size_t kMostPlayouts = 6;  // lines below the table

}  // namespace

struct InstrumentPanel::Layout {
  Layout(const PanelFrame& frame, const PanelInk& ink, std::span<const GuestRecord> records) {
    const std::size_t guests = records.size();
    const float em = ink.em();
    row = 1.3f * em;
    margin = 0.7f * em;
    float numbers = 0.0f;
    for (const Column& column : kColumns) numbers += column.width_em * em;
    name = 6.0f * em;
    for (const GuestRecord& record : records)
      name = std::max(name, ink.width_of(record.guest().c_str()) + 0.7f * em);
    const float room = frame.width_px - 4.0f * margin;
    const float plots_least = 17.0f * em;
    const float bar_usual = 14.0f * em;
    has_plots = room >= name + numbers + 8.0f * em + plots_least;
    const float for_table = has_plots ? room - plots_least - margin : room;
    bar = std::clamp(for_table - name - numbers - 1.2f * em, 5.0f * em, bar_usual);
    left = 2.0f * margin;
    top = 2.0f * margin;
    bar_left = left + name;
    numbers_left = bar_left + bar + 0.6f * em;
    table_right = numbers_left + numbers;
    plots_left = table_right + 1.6f * em;
    right = has_plots ? frame.width_px - 2.0f * margin : table_right;
    legend = top;
    const float head_rows = 2.0f;
    lines = std::min(kMostPlayouts, static_cast<std::size_t>(std::count_if(
                                        records.begin(), records.end(), [](const auto& record) {
                                          return record.playout.has_value();
                                        })));
    const float line_rows = static_cast<float>(lines) + 0.3f;
    const float room_y = frame.height_px - 2.0f * top - (head_rows + line_rows) * row - 3.4f * em;
    rows = std::min(guests, static_cast<std::size_t>(std::max(1.0f, room_y / row)));
    plots_height = has_plots ? std::min(frame.height_px - 4.0f * margin, 33.0f * em) : 0.0f;
  }
  float row, margin, name, bar, left, top, bar_left, numbers_left, table_right, plots_left, right;
  float legend, heads = 0.0f, table = 0.0f, bottom = 0.0f, plots_height;
  std::size_t rows = 0, lines = 0;
  bool has_plots = false;
};

std::span<const KeyHelp> InstrumentPanel::keys() const { return kKeys; }

std::size_t InstrumentPanel::chosen_place() const {
  const auto& guests = records_.guests();
  for (std::size_t i = 0; i < guests.size(); ++i)
    if (guests[i].guest() == chosen_) return i;
  return 0;
}

bool InstrumentPanel::on_key(const KeyPress& press) {
  const bool closes = is_open_ && press.key == GLFW_KEY_ESCAPE;
  if (closes || (press.key == GLFW_KEY_I && !press.has_control && !press.is_repeat)) {
    is_open_ = !is_open_;
    return true;
  }
  const std::size_t count = records_.guests().size();
  if (!is_open_ || press.key != GLFW_KEY_TAB || count == 0) return false;
  const std::size_t step = press.has_shift ? count - 1 : 1;
  chosen_ = records_.guests()[(chosen_place() + step) % count].guest();
  return true;
}

void InstrumentPanel::draw_heads(const PanelInk& ink, const Layout& layout) const {
  const float units = layout.heads + 1.05f * ink.em();
  ink.left(layout.left, layout.heads, kDim, "guest");
  float x = layout.numbers_left;
  for (const Column& column : kColumns) {
    x += column.width_em * ink.em();
    ink.right(x, layout.heads, kBright, column.head);
    ink.right(x, units, kDim, column.unit);
  }
}

void InstrumentPanel::draw_row(const PanelInk& ink, const Layout& layout, const GuestRecord& record,
                               float y) const {
  const float em = ink.em();
  const std::string name(record.guest().view());
  ink.list().PushClipRect({layout.left, y}, {layout.bar_left - 0.3f * em, y + layout.row}, true);
  ink.left(layout.left, y + 0.1f * em, kBright, name.c_str());
  ink.list().PopClipRect();
  if (record.size() == 0) return;
  const GuestStats& stats = record.newest();
  float x = layout.numbers_left;
  for (const Column& column : kColumns) {
    x += column.width_em * em;
    ink.number(x, y + 0.1f * em, kBright, column.format, column.figure(stats));
  }
}

void InstrumentPanel::draw_table(const PanelInk& ink, const Layout& layout) {
  const auto& guests = records_.guests();
  const float em = ink.em();
  draw_heads(ink, layout);
  float longest_ms = 0.0f;
  for (const GuestRecord& record : guests)
    if (record.size() > 0 && std::isfinite(record.newest().newest_p50_ms))
      longest_ms = std::max(longest_ms, record.newest().newest_p50_ms);
  const float scale_ms = bar_scale_ms(longest_ms);
  const auto bar_box = [&](float y) {
    return BarBox{layout.bar_left, y + 0.15f * em, layout.bar_left + layout.bar, y + 1.05f * em};
  };
  draw_bar_ticks(ink, bar_box(layout.heads + 0.9f * em), scale_ms);
  const std::size_t chosen = chosen_place();
  const std::size_t half = layout.rows / 2;
  const std::size_t first =
      std::min(chosen > half ? chosen - half : 0, guests.size() - layout.rows);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (std::size_t i = 0; i < layout.rows; ++i) {
    const GuestRecord& record = guests[first + i];
    const float y = layout.table + static_cast<float>(i) * layout.row;
    const ImVec2 low(layout.left - 0.3f * em, y),
        high(layout.table_right + 0.3f * em, y + layout.row);
    if (first + i == chosen && layout.has_plots)
      ink.list().AddRectFilled(low, high, kChosen, 0.2f * em);
    const bool is_under =
        mouse.x >= low.x && mouse.x < high.x && mouse.y >= low.y && mouse.y < high.y;
    if (is_under && ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) chosen_ = record.guest();
    draw_row(ink, layout, record, y);
    if (record.size() > 0) draw_latency_bar(ink, record.newest(), bar_box(y), scale_ms);
  }
  const float below = layout.table + static_cast<float>(layout.rows) * layout.row;
  float y = below + (layout.rows == guests.size() ? 0.3f : 1.3f) * layout.row;
  std::size_t lines = 0;
  for (std::size_t i = 0; i < layout.rows && lines < layout.lines; ++i) {
    const GuestRecord& record = guests[first + i];
    if (!record.playout) continue;
    ++lines;
    const std::string words =
        std::string(record.guest().view()) + " is shown " + playout_text(*record.playout);
    ink.list().PushClipRect({layout.left, y}, {layout.table_right, y + layout.row}, true);
    ink.left(layout.left, y, first + i == chosen ? kBright : kDim, words.c_str());
    ink.list().PopClipRect();
    y += layout.row;
  }
  if (layout.rows == guests.size()) return;
  char words[64];
  std::snprintf(words, sizeof words, "guests %zu to %zu of %zu; Tab goes on", first + 1,
                first + layout.rows, guests.size());
  ink.left(layout.left, below, kDim, words);
}

void InstrumentPanel::draw_plots(const PanelInk& ink, const Layout& layout) const {
  const GuestRecord& record = records_.guests()[chosen_place()];
  const float em = ink.em();
  ink.left(layout.plots_left, layout.top, kBright, std::string(record.guest().view()).c_str());
  ink.right(layout.right, layout.top, kDim, "last minute");
  constexpr std::size_t kAcross = 2, kDown = kPlots.size() / kAcross;
  const float table_height = 1.3f * em * static_cast<float>(kGapCount / 2 + 1) + 0.7f * em;
  if (record.size() > 0)
    draw_gap_table(ink, record.newest(),
                   {layout.plots_left, layout.top + 1.7f * em, layout.right, layout.bottom});
  const float top = layout.top + 1.7f * em + table_height, gap = 0.9f * em;
  const float width = (layout.right - layout.plots_left - gap) / kAcross;
  const float height =
      (layout.top + layout.plots_height - top - gap * (kDown - 1)) / static_cast<float>(kDown);
  for (std::size_t i = 0; i < kPlots.size(); ++i) {
    const float x = layout.plots_left + static_cast<float>(i % kAcross) * (width + gap);
    const float y = top + static_cast<float>(i / kAcross) * (height + gap);
    draw_minute_plot(ink, kPlots[i], record, {x, y, x + width, y + height});
  }
}

void InstrumentPanel::draw(const PanelFrame& frame) {
  if (!is_open_ || frame.small_font == nullptr) return;
  constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav;
  PanelInk measure(*ImGui::GetBackgroundDrawList(), *frame.small_font);
  Layout layout(frame, measure, records_.guests());
  const float em = measure.em();
  // Once to know its height, outside of all pictures.
  measure.list().PushClipRect({-kMost_px, -kMost_px}, {-kMost_px + 1.0f, -kMost_px + 1.0f});
  const float legend_height =
      draw_bar_legend(measure, layout.left, layout.legend, layout.table_right);
  measure.list().PopClipRect();
  layout.heads = layout.legend + legend_height + 0.3f * em;
  layout.table = layout.heads + 2.3f * em;
  const bool is_cut = layout.rows < records_.guests().size();
  const float table_end =
      layout.table + (static_cast<float>(std::max<std::size_t>(layout.rows, 1)) +
                      (is_cut ? 1.3f : 0.3f) + static_cast<float>(layout.lines)) *
                         layout.row;
  layout.bottom = std::max(table_end, layout.top + layout.plots_height) + layout.margin;
  ImGui::SetNextWindowPos({layout.margin, layout.margin});
  ImGui::SetNextWindowSize(
      {layout.right + layout.margin - layout.margin, layout.bottom - layout.margin});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  if (ImGui::Begin("instruments", nullptr, kPlain)) {
    const PanelInk ink(*ImGui::GetWindowDrawList(), *frame.small_font);
    ink.list().AddRectFilled({layout.margin, layout.margin},
                             {layout.right + layout.margin, layout.bottom}, kPaper, 0.5f * em);
    draw_bar_legend(ink, layout.left, layout.legend, layout.table_right);
    if (records_.guests().empty()) {
      ink.left(layout.left, layout.heads, kBright,
               "nothing has come yet: figures appear a second after the first pose");
    } else {
      draw_table(ink, layout);
      if (layout.has_plots) draw_plots(ink, layout);
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace dance
