#include "viewer/window/help_panel.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace dance {
namespace {

constexpr float kLargestFont_px = 19.0f;
constexpr float kSmallestFont_px = 10.0f;  // still read on a monitor of this scale
constexpr int kMostColumns = 4;
constexpr float kLine = 1.45f;   // of the font's size
constexpr float kMargin = 1.4f;  // round the whole
constexpr float kGap = 1.6f;     // between columns
constexpr float kAfterKey = 1.1f;

ImU32 ink(float r, float g, float b, float a) {
  return ImGui::ColorConvertFloat4ToU32(ImVec4(r, g, b, a));
}

// A heading, a key with its words, or the space after a group.
struct Line {
  std::string_view key;
  std::string_view what;
  bool is_heading = false;
};

using Lines = std::vector<Line>;

// One heading has the keys of the window and those of a panel; measurements come last.
std::vector<Text> headings_of(const std::vector<PanelStack::Group>& groups) {
  std::vector<Text> headings;
  for (const PanelStack::Group& group : groups)
    if (std::ranges::find(headings, group.title) == headings.end()) headings.push_back(group.title);
  std::ranges::stable_partition(headings, [](Text text) { return text != Text::kKeysEngineers; });
  return headings;
}

Lines lines_of(const std::vector<PanelStack::Group>& groups, const Texts& texts) {
  Lines lines;
  for (const Text heading : headings_of(groups)) {
    if (!lines.empty()) lines.push_back({});
    lines.push_back({texts[heading], {}, true});
    for (const PanelStack::Group& group : groups)
      for (const KeyHelp& help : group.keys)
        if (group.title == heading) lines.push_back({help.key_in(texts), texts[help.what]});
  }
  return lines;
}

float width_of(const ImFont& font, float size_px, std::string_view text) {
  if (text.empty()) return 0.0f;  // ImGui takes an end of null for "up to the zero byte"
  return font.CalcTextSizeA(size_px, 1e6f, 0.0f, text.data(), text.data() + text.size()).x;
}

// Lines of the group that begins at `heading`.
std::size_t group_size(const Lines& lines, std::size_t heading) {
  std::size_t end = heading + 1;
  while (end < lines.size() && !lines[end].key.empty()) ++end;
  return end - heading;
}

// Puts lines into columns of at most `most`. A group stays together where it can; no heading stands
// at the foot of a column, no space at its head.
std::vector<Lines> columns_of(const Lines& lines, std::size_t most) {
  std::vector<Lines> columns(1);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_space = lines[i].key.empty();
    const std::size_t group = lines[i].is_heading ? group_size(lines, i) : 1;
    const std::size_t wants = group <= most ? group : 2;
    if (columns.back().size() + wants > most && !columns.back().empty()) columns.emplace_back();
    if (is_space && columns.back().empty()) continue;
    columns.back().push_back(lines[i]);
  }
  while (columns.size() > 1 && columns.back().empty()) columns.pop_back();
  return columns;
}

struct Layout {
  float size_px = 0.0f;
  float key_px = 0.0f;     // width of the widest key
  float column_px = 0.0f;  // of a whole column
  std::size_t rows = 1;    // in a column
  int columns = 1;         // side by side on a page
  std::vector<Lines> all;
};

Layout lay_out(const ImFont& font, const Lines& lines, float size_px, float width_px,
               float height_px) {
  Layout layout;
  layout.size_px = size_px;
  float what_px = 0.0f;
  float heading_px = 0.0f;
  for (const Line& line : lines) {
    float& widest = line.is_heading ? heading_px : layout.key_px;
    widest = std::max(widest, width_of(font, size_px, line.key));
    what_px = std::max(what_px, width_of(font, size_px, line.what));
  }
  layout.column_px = std::max(layout.key_px + kAfterKey * size_px + what_px, heading_px);
  const float room_px = height_px - (2.0f * kMargin + 1.0f) * size_px;
  layout.rows = static_cast<std::size_t>(std::max(2.0f, std::floor(room_px / (kLine * size_px))));
  const float wide_px = width_px - 2.0f * kMargin * size_px + kGap * size_px;
  layout.columns =
      std::clamp(static_cast<int>(wide_px / (layout.column_px + kGap * size_px)), 1, kMostColumns);
  layout.all = columns_of(lines, layout.rows);
  return layout;
}

// The largest letters with which all fits on one page, else the smallest.
Layout best_layout(const PanelFrame& frame, const Lines& lines) {
  for (float size = kLargestFont_px; size > kSmallestFont_px; size -= 1.0f) {
    Layout layout = lay_out(*frame.large_font, lines, std::round(size * frame.scale),
                            frame.width_px, frame.height_px);
    if (layout.all.size() > static_cast<std::size_t>(layout.columns)) continue;
    const float needed_px =
        static_cast<float>(layout.all.size()) * (layout.column_px + kGap * layout.size_px);
    if (needed_px > frame.width_px) continue;
    // Columns of nearly the same length look better than a full one and a rest.
    const auto columns = std::min<std::size_t>(static_cast<std::size_t>(layout.columns),
                                               std::max<std::size_t>(layout.all.size(), 2));
    for (std::size_t rows = (lines.size() + columns - 1) / columns; rows < layout.rows; ++rows) {
      std::vector<Lines> even = columns_of(lines, rows);
      if (even.size() > columns) continue;
      layout.all = std::move(even);
      break;
    }
    return layout;
  }
  return lay_out(*frame.large_font, lines, std::round(kSmallestFont_px * frame.scale),
                 frame.width_px, frame.height_px);
}

void draw_column(ImDrawList& list, ImFont* font, const Layout& layout, const Lines& column, float x,
                 float y) {
  const auto put = [&](float left, float top, ImU32 colour, std::string_view text) {
    list.AddText(font, layout.size_px, ImVec2(std::round(left), std::round(top)), colour,
                 text.data(), text.data() + text.size());
  };
  for (const Line& line : column) {
    if (line.is_heading) {
      put(x, y, ink(0.55f, 0.75f, 1.0f, 0.95f), line.key);
    } else if (!line.key.empty()) {
      put(x, y, ink(1.0f, 0.86f, 0.55f, 1.0f), line.key);
      put(x + layout.key_px + kAfterKey * layout.size_px, y, ink(1.0f, 1.0f, 1.0f, 0.92f),
          line.what);
    }
    y += kLine * layout.size_px;
  }
}

}  // namespace

bool HelpPanel::on_key(const KeyPress& press) {
  if (press.key == GLFW_KEY_F1) {
    page_ = page_ + 1 < pages_ ? page_ + 1 : -1;
    if (page_ < 0) pages_ = 1;
    return true;
  }
  if (page_ < 0 || press.key != GLFW_KEY_ESCAPE) return false;
  page_ = -1;
  pages_ = 1;
  return true;
}

void HelpPanel::draw(const PanelFrame& frame) {
  if (page_ < 0) return;
  std::vector<PanelStack::Group> groups = own_;
  for (const PanelStack::Group& group : panels_.key_groups()) groups.push_back(group);
  const Texts texts(frame.language);
  const Lines lines = lines_of(groups, texts);
  const Layout layout = best_layout(frame, lines);
  const auto a_page = static_cast<std::size_t>(layout.columns);
  pages_ = static_cast<int>((layout.all.size() + a_page - 1) / a_page);
  page_ = std::min(page_, pages_ - 1);
  const std::size_t first = static_cast<std::size_t>(page_) * a_page;
  const std::size_t shown = std::min(a_page, layout.all.size() - first);

  std::size_t longest = 1;
  for (std::size_t c = first; c < first + shown; ++c)
    longest = std::max(longest, layout.all[c].size());
  const float size = layout.size_px;
  const float margin = kMargin * size;
  const float gap = kGap * size;
  const float width = static_cast<float>(shown) * (layout.column_px + gap) - gap + 2.0f * margin;
  const float foot = pages_ > 1 ? size : 0.0f;
  const float height = static_cast<float>(longest) * kLine * size + 1.6f * margin + foot;
  const float left = std::max(0.0f, 0.5f * (frame.width_px - width));
  const float top = std::max(0.0f, 0.5f * (frame.height_px - height));
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddRectFilled({left, top}, {left + width, top + height}, ink(0.03f, 0.035f, 0.06f, 0.9f),
                     0.6f * size);
  for (std::size_t c = 0; c < shown; ++c)
    draw_column(list, frame.large_font, layout, layout.all[first + c],
                left + margin + static_cast<float>(c) * (layout.column_px + gap),
                top + 0.8f * margin);
  if (pages_ <= 1) return;
  const std::string foot_words =
      texts.say(Text::kKeysPage, {std::to_string(page_ + 1), std::to_string(pages_)});
  list.AddText(frame.large_font, size,
               {std::round(left + margin), std::round(top + height - 1.6f * size)},
               ink(1.0f, 1.0f, 1.0f, 0.6f), foot_words.c_str());
}

}  // namespace dance
