// The rows of guests in the timeline, what is said where the mouse is, and what can be exported.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "formats/body/guest_look.h"
#include "viewer/replay/timeline/timeline_ink.h"
#include "viewer/scene/scene.h"
#include "viewer/words/shown_name.h"

namespace dance {
namespace {

ImU32 colour_of(const GuestId& guest, float alpha) {
  const Eigen::Vector3f c = srgb_from_linear(look_of(guest).tag);
  return ImGui::ColorConvertFloat4ToU32(ImVec4(c.x(), c.y(), c.z(), alpha));
}

// "2.4 s", "0.3 s".
std::string seconds_text(Duration length) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", length.as_seconds());
  return text.data();
}

// In the order of ExportKind.
constexpr std::array<Text, 4> kKinds{Text::kExportVideo, Text::kExportPictures, Text::kExportGlb,
                                     Text::kExportBvh};

}  // namespace

// Each guest's own row while there is room; those beyond share one, in which their lapses are.
void TimelinePanel::draw_guests(const Ink& ink, const Box& box) const {
  const ReplayIndex& index = *source_.index();
  const float em = ink.em();
  const auto x_within = [&](MonoTime t) {
    return std::clamp(scale_->x_of(t), box.bar_left, box.bar_right);
  };
  const auto row_of = [&](std::size_t guest) {
    return box.guest_rows + box.row * static_cast<float>(std::min(guest, box.rows));
  };
  const std::size_t shown = index.guests.size();
  for (std::size_t i = 0; i < shown; ++i) {
    const ReplayIndex::Guest& guest = index.guests[i];
    const float y = row_of(i);
    const float middle = y + 0.5f * box.row;
    const bool is_own = i < box.rows;
    if (is_own)
      ink.clipped(box.left + 0.8f * em, box.bar_left - 0.3f * em, y + 0.02f * em, kDim,
                  shown_name(names_, guest.id, texts_).data());
    if (guest.last < scale_->from() || guest.first > scale_->to()) continue;
    const float from = x_within(guest.first);
    const float to = std::max(x_within(guest.last), from + 1.0f);
    ink.list().AddRectFilled({from, middle - 0.16f * em}, {to, middle + 0.16f * em},
                             is_own ? colour_of(guest.id, 0.85f) : ink_of(0xa7adbd, 60), 0.1f * em);
  }
  if (box.has_more) {
    const std::string words = "and " + std::to_string(shown - box.rows) + " more";
    ink.clipped(box.left + 0.8f * em, box.bar_left - 0.3f * em, row_of(shown), kDim, words.c_str());
  }
  // Two lapses on one pixel are one mark.
  std::array<float, 16> last_x;
  last_x.fill(-1.0f);
  for (const ReplayIndex::Gap& gap : index.gaps) {
    if (gap.end < scale_->from() || gap.begin > scale_->to()) continue;
    const float middle = row_of(gap.guest) + 0.5f * box.row;
    const float from = x_within(gap.begin);
    const float to = std::max(x_within(gap.end), from + std::max(2.0f, 0.14f * em));
    float& last = last_x[std::min<std::size_t>(std::min<std::size_t>(gap.guest, box.rows), 15)];
    if (to <= last) continue;
    last = to;
    ink.list().AddRectFilled({from, middle - 0.36f * em}, {to, middle + 0.36f * em}, kLapse,
                             0.08f * em);
  }
}

// The lapse under the mouse.
std::string TimelinePanel::gap_text(MonoTime moment, float y, const Box& box) const {
  const ReplayIndex& index = *source_.index();
  const float row = std::floor((y - box.guest_rows) / box.row);
  if (row < 0.0f || row > static_cast<float>(box.rows)) return "";
  const auto at = static_cast<std::size_t>(row);
  const double near_s = 2.0 / std::max(scale_->pixels_per_second(), 1e-9);
  for (const ReplayIndex::Gap& gap : index.gaps) {
    if (std::min<std::size_t>(gap.guest, box.rows) != at) continue;
    if (moment < gap.begin - Duration::seconds(near_s) ||
        moment > gap.end + Duration::seconds(near_s))
      continue;
    return std::string(shown_name(names_, index.guests[gap.guest].id, texts_)) + ": nothing for " +
           seconds_text(gap.end - gap.begin);
  }
  if (at >= index.guests.size() || at >= box.rows) return "";
  return std::string(shown_name(names_, index.guests[at].id, texts_));
}

void TimelinePanel::draw_hover(const Ink& ink, const Box& box) const {
  if (!hover_px_) return;
  const float em = ink.em();
  const MonoTime moment = scale_->moment_at(*hover_px_);
  std::array<char, 32> fine{};
  const double seconds = (moment - source_.index()->begin).as_seconds();
  std::snprintf(fine.data(), fine.size(), ".%02d",
                static_cast<int>(std::floor(seconds * 100.0)) % 100);
  std::string words = clock_text(std::floor(seconds), 1.0) + fine.data();
  if (const std::string bar = bar_text(source_.index()->beats, moment); !bar.empty())
    words += "   " + bar;
  if (const std::string gap = gap_text(moment, *hover_y_px_, box); !gap.empty())
    words += "   " + gap;
  ink.list().AddRectFilled({*hover_px_, box.bar}, {*hover_px_ + 1.0f, box.times},
                           ink_of(0xffffff, 150));
  const float width = ink.width_of(words.c_str()) + em;
  const float left = std::clamp(*hover_px_ - 0.5f * width, box.left, box.right - width);
  // Above the panel, and in front of everything.
  ImDrawList& front = *ImGui::GetForegroundDrawList();
  front.AddRectFilled({left, box.top - 1.9f * em}, {left + width, box.top - 0.3f * em}, kPaper,
                      0.3f * em);
  PanelInk(front, ink.font()).left(left + 0.5f * em, box.top - 1.7f * em, kBright, words.c_str());
}

void TimelinePanel::draw_export(const Ink& ink, const Box& box) {
  const bool runs = exports();
  if (asks_of_running_ && !runs) ask_about_export(false);  // it has ended meanwhile
  if (!asks_what_to_export_) return;
  const float em = ink.em();
  const float width = 19.0f * em;
  const float height = (runs ? 2.0f : static_cast<float>(kKinds.size())) * 1.7f * em + 2.4f * em;
  const float left = std::min(box.left + 20.0f * em, std::max(box.left, box.right - width));
  const ImVec2 low{left, box.top - height - 0.4f * em};
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({width, height});
  ImGui::Begin("export", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  const Ink menu{{*ImGui::GetWindowDrawList(), ink.font()}};
  menu.panel(low, {low.x + width, low.y + height});
  menu.left(low.x + 0.8f * em, low.y + 0.5f * em, kDim,
            texts_[runs ? Text::kExportRuns : Text::kExportAsks]);
  float y = low.y + 2.0f * em;
  const auto choice = [&](const char* words) {
    ImGui::SetCursorScreenPos({low.x + 0.4f * em, y});
    const bool is_pressed = ImGui::InvisibleButton(words, {width - 0.8f * em, 1.6f * em});
    if (ImGui::IsItemHovered())
      menu.bar({low.x + 0.4f * em, y}, {low.x + width - 0.4f * em, y + 1.6f * em}, kChosen);
    menu.left(low.x + 0.8f * em, y + 0.25f * em, kBright, words);
    y += 1.7f * em;
    return is_pressed;
  };
  if (runs) {
    if (choice(texts_[Text::kExportCancel])) exporting_.cancel(), ask_about_export(false);
    if (choice(texts_[Text::kExportGoesOn])) ask_about_export(false);
  } else {
    for (std::size_t i = 0; i < kKinds.size(); ++i)
      if (choice((std::to_string(i + 1) + "  " + texts_[kKinds[i]]).c_str())) {
        exporting_.start(static_cast<ExportKind>(i));
        ask_about_export(false);
      }
  }
  ImGui::End();
}

}  // namespace dance
