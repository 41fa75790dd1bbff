#include "viewer/dance_panel/own/own_choices.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/printable.h"
#include "viewer/dance_panel/panel_style.h"

namespace dance {
namespace {

constexpr ImU32 kFieldInk = IM_COL32(26, 31, 43, 240);
constexpr ImU32 kMarkedInk = IM_COL32(61, 111, 181, 200);

// Like a shell's, at the begin of a path.
std::string without_tilde(const std::string& path) {
  const char* home = std::getenv("HOME");
  return path.starts_with("~/") && home != nullptr ? home + path.substr(1) : path;
}

}  // namespace

void OwnChoices::open(Open what, const GuestId& guest) {
  open_ = open_ == what && guest_ == guest ? Open::kNone : what;
  guest_ = guest;
  trouble_.clear();
  editor_.clear();
  if (open_ == Open::kFigures) listed_ = figures_.list();
}

bool OwnChoices::on_key(const KeyPress& press) {
  if (!is_typed_in()) return false;
  const bool is_enter = press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER;
  if (press.key == GLFW_KEY_ESCAPE) {
    close();
  } else if (is_enter) {
    if (!press.is_repeat) apply_line();
  } else if (editor_.on_key(press)) {
    return true;
  } else if (press.has_control && press.key == GLFW_KEY_V) {
    if (const char* text = ImGui::GetClipboardText()) editor_.insert(std::string_view(text));
  } else if (press.has_control && (press.key == GLFW_KEY_C || press.key == GLFW_KEY_X)) {
    if (!editor_.selection().empty()) ImGui::SetClipboardText(editor_.selection().c_str());
    if (press.key == GLFW_KEY_X) editor_.erase_selection();
  }
  return true;
}

bool OwnChoices::on_character(char32_t character) {
  if (!is_typed_in()) return false;
  editor_.insert(character);
  return true;
}

// A name that is refused stays in the field, with the reason below.
void OwnChoices::apply_line() {
  const std::string line = editor_.text();
  trouble_.clear();
  if (open_ == Open::kFile) {
    OwnFigure figure;
    figure.what = without_tilde(line);
    if (!figure.what.empty() && !figure.is_file()) figure.what.insert(0, "./");
    if (!figure.what.empty()) figures_.choose(guest_, figure);
    return close();
  }
  const auto name = line.empty() ? ShownName() : parse_shown_name(line);
  if (!name) {
    trouble_ = texts_[Text::kOwnNameRule];
    return;
  }
  needs_.rename(guest_, *name);
  if (needs_.keep_name)
    if (const auto kept = needs_.keep_name(guest_, name->view()); !kept)
      trouble_ = printable(kept.error().what);
  close();
}

void OwnChoices::draw(PanelControls& controls, const GuestId& guest, std::string_view name) {
  const float begin = ImGui::GetCursorPosY();
  if (guest_ != guest) close();
  bool is_first = true;
  const auto button = [&](const char* id, Text label) {
    if (!is_first) controls.flow(controls.width_of(texts_[label]));
    is_first = false;
    return controls.button(id, texts_[label]);
  };
  if (needs_.rename && button("own-name", Text::kOwnName)) {
    open(Open::kName, guest);
    if (open_ == Open::kName) editor_.insert(name);
  }
  if (figures_.is_there() && button("own-figure", Text::kOwnFigure)) open(Open::kFigures, guest);
  if (open_ == Open::kFigures) draw_figures(controls, guest);
  if (is_typed_in()) draw_line(controls);
  if (figures_.is_busy()) panel_style::text(panel_style::kQuiet, texts_[Text::kOwnFigureComes]);
  if (!trouble().empty()) panel_style::text(panel_style::kFair, trouble().c_str());
  height_px_ = ImGui::GetCursorPosY() - begin;
}

// A file is looked for: not in each picture.
const GuestId& OwnChoices::voice_guest(const std::vector<DanceGuest>& guests, MonoTime now) {
  constexpr Duration kReadEvery = Duration::s(1);
  if (!needs_.has_voice_switch || (voice_read_.is_set() && now - voice_read_ < kReadEvery))
    return voice_guest_;
  voice_read_ = now;
  const auto found = std::ranges::find_if(guests, [&](const DanceGuest& guest) {
    return !guest.is_remote && needs_.has_voice_switch(guest.id);
  });
  voice_guest_ = found == guests.end() ? GuestId() : found->id;
  return voice_guest_;
}

void OwnChoices::switch_voice(const GuestId& guest, bool is_on) {
  trouble_.clear();
  auto done = needs_.switch_voice(guest, is_on);
  if (done && needs_.keep_voice) done = needs_.keep_voice(guest, is_on);
  if (!done) trouble_ = printable(done.error().what);
}

void OwnChoices::draw_figures(PanelControls& controls, const GuestId& guest) {
  if (controls.button("mannequin", texts_[Text::kLobbyMannequin])) figures_.choose(guest, {});
  const auto next = [&](const char* id, const std::string& label) {
    const std::string shown = panel_style::fitted(label, 12.0f * ImGui::GetFontSize());
    controls.flow(controls.width_of(shown.c_str()));
    return controls.button(id, shown.c_str());
  };
  if (next("any-look", texts_[Text::kFigureSurprise]))
    figures_.choose_any_look(guest, guest.view().size() + 31 * ++looks_ +
                                        static_cast<std::uint64_t>(ImGui::GetFrameCount()));
  std::size_t unnamed = 0;
  for (const NamedFigure& figure : listed_) {
    const std::string label = figure.name.empty()
                                  ? texts_.say(Text::kOwnFigureStored, {std::to_string(++unnamed)})
                                  : printable(figure.name);
    if (next(figure.what.c_str(), label)) {
      OwnFigure chosen;
      chosen.what = figure.what;
      figures_.choose(guest, chosen);
    }
  }
  if (next("own-file", texts_[Text::kOwnFigureFile])) open(Open::kFile, guest);
}

void OwnChoices::draw_line(PanelControls& controls) {
  panel_style::text(panel_style::kQuiet,
                    texts_[open_ == Open::kName ? Text::kOwnNameHint : Text::kOwnFileHint]);
  draw_text();
  if (controls.mouse_button("own-apply", texts_[Text::kOwnApply], PanelControls::Look::kStrong))
    apply_line();
  ImGui::SameLine();
  if (controls.mouse_button("own-cancel", texts_[Text::kOwnCancel], PanelControls::Look::kPlain))
    close();
}

// Scrolls a long line, so that the caret stays visible.
void OwnChoices::draw_text() const {
  const float em = ImGui::GetFontSize(), pad = 0.3f * em;
  const float width = ImGui::GetContentRegionAvail().x - pad;
  const auto width_of = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
  const ImVec2 low = ImGui::GetCursorScreenPos(), high{low.x + width, low.y + em + 2.0f * pad};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, kFieldInk, 0.25f * em);
  list.PushClipRect(low, high, true);
  const float caret = width_of(editor_.before_caret());
  const float left = std::round(low.x + pad - std::max(0.0f, caret - width + 3.0f * pad));
  const float y = low.y + pad, marked = left + width_of(editor_.before_selection());
  if (const std::string selection = editor_.selection(); !selection.empty())
    list.AddRectFilled({marked, y}, {marked + width_of(selection), y + em}, kMarkedInk);
  list.AddText({left, y}, panel_style::kText, editor_.text().c_str());
  list.AddRectFilled({left + caret, y}, {left + caret + std::max(1.0f, 0.08f * em), y + em},
                     panel_style::kText);
  list.PopClipRect();
  ImGui::Dummy({width, em + 2.0f * pad});
}

}  // namespace dance
