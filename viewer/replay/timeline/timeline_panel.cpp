#include "viewer/replay/timeline/timeline_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "viewer/replay/timeline/timeline_ink.h"

namespace dance {
namespace {

constexpr std::array<KeyHelp, 11> kKeys{{
    {"", Text::kDoPlay, Text::kKeySpace},
    {", .", Text::kDoFrame},
    {"← →", Text::kDoJump},
    {"", Text::kDoBeat, Text::kKeyShiftArrows},
    {"", Text::kDoBar, Text::kKeyControlArrows},
    {"", Text::kDoEnds, Text::kKeyHomeEnd},
    {"↓ ↑", Text::kDoSlower},
    {"[ ]", Text::kDoLoopEdges},
    {"L", Text::kDoLoop},
    {"E", Text::kDoExport},
    {"", Text::kDoZoomTime, Text::kKeyWheel},
}};
constexpr Duration kJump = Duration::s(5);

}  // namespace

std::span<const KeyHelp> TimelinePanel::keys() const { return kKeys; }

float TimelinePanel::bottom_px(const PanelFrame& frame) const {
  const std::size_t guests = source_.index() ? source_.index()->guests.size() : 0;
  return frame.height_px - Box(frame, letter_height(frame), guests).top;
}

bool TimelinePanel::on_key(const KeyPress& press) {
  if (on_export_key(press)) return true;
  ReplayPlayer* player = source_.player();
  return player != nullptr && on_player_key(press, *player);
}

bool TimelinePanel::on_player_key(const KeyPress& press, ReplayPlayer& player) {
  const auto along = [&](int sign) {
    if (press.has_control)
      player.jump_bars(sign);
    else if (press.has_shift)
      player.jump_beats(sign);
    else
      player.jump(kJump * sign);
    return true;
  };
  switch (press.key) {
    case GLFW_KEY_LEFT:
      return along(-1);
    case GLFW_KEY_RIGHT:
      return along(1);
    case GLFW_KEY_COMMA:
      return player.step_frames(-1), true;
    case GLFW_KEY_PERIOD:
      return player.step_frames(1), true;
    case GLFW_KEY_HOME:
      return player.go_to(player.index().begin), true;
    case GLFW_KEY_END:
      return player.go_to(player.index().end), true;
    case GLFW_KEY_UP:
      return player.change_speed(1), true;
    case GLFW_KEY_DOWN:
      return player.change_speed(-1), true;
    default:
      break;
  }
  if (press.is_repeat) return press.key == GLFW_KEY_SPACE || press.key == GLFW_KEY_L;
  switch (press.key) {
    case GLFW_KEY_SPACE:
      return player.toggle_playing(), true;
    case GLFW_KEY_LEFT_BRACKET:
      return player.set_loop_begin(), true;
    case GLFW_KEY_RIGHT_BRACKET:
      return player.set_loop_end(), true;
    case GLFW_KEY_L:
      press.has_shift ? player.clear_loop() : player.toggle_loop();
      return true;
    case GLFW_KEY_E:
      if (!exporting_.start) return false;
      ask_about_export(true);
      return true;
    default:
      return false;
  }
}

void TimelinePanel::ask_about_export(bool asks) {
  asks_what_to_export_ = asks;
  asks_of_running_ = asks && exports();
}

// While it is asked what to export, and keys that would close the window over one that is written.
bool TimelinePanel::on_export_key(const KeyPress& press) {
  const bool closes = press.key == GLFW_KEY_ESCAPE || press.key == GLFW_KEY_Q;
  const bool runs = exports();
  if (asks_of_running_ && !runs) ask_about_export(false);  // it has ended meanwhile
  if (runs && closes && press.is_repeat) return true;
  if (!asks_what_to_export_) {
    if (!runs || !closes) return false;
    ask_about_export(true);
    return true;
  }
  if (press.key == GLFW_KEY_Q) return runs;
  if (press.key == GLFW_KEY_ESCAPE || press.key == GLFW_KEY_E) {
    if (runs && exporting_.cancel && press.key == GLFW_KEY_ESCAPE) exporting_.cancel();
    ask_about_export(false);
    return true;
  }
  if (press.key < GLFW_KEY_1 || press.key > GLFW_KEY_4) return false;
  if (!runs) exporting_.start(static_cast<ExportKind>(press.key - GLFW_KEY_1));
  ask_about_export(false);
  return true;
}

void TimelinePanel::draw(const PanelFrame& frame) {
  const std::size_t guests = source_.index() ? source_.index()->guests.size() : 0;
  const float em = letter_height(frame);
  texts_ = Texts(frame.language);
  names_ = frame.scene.names;
  const Box box(frame, em, guests);
  // A window of Dear ImGui's, so that it has the mouse where it is, and the camera elsewhere.
  ImGui::SetNextWindowPos({box.left, box.top});
  ImGui::SetNextWindowSize({box.right - box.left, box.bottom - box.top});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
  ImGui::Begin("timeline", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoScrollWithMouse);
  const Ink ink{{*ImGui::GetWindowDrawList(), *frame.small_font}};
  ink.panel({box.left, box.top}, {box.right, box.bottom});
  if (ReplayPlayer* player = source_.player()) {
    if (!scale_) scale_.emplace(player->index().begin, player->index().end);
    scale_->set_width(box.bar_left, box.bar_right);
    // Also where a key has gone while it is paused; else a person may look elsewhere.
    if (!is_scrubbing_ && player->position() != followed_) scale_->follow(player->position());
    followed_ = player->position();
    use_mouse(box, *player);
    draw_controls(ink, box, *player);
    draw_bar(ink, box, *player);
    draw_guests(ink, box);
    draw_hover(ink, box);
    draw_export(ink, box);
    draw_tip(ink, box);
  } else {
    draw_waiting(ink, box);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void TimelinePanel::draw_waiting(const Ink& ink, const Box& box) const {
  const std::string note = source_.note();
  ink.left(box.left + ink.em(), box.controls, kBright, note.c_str());
  const float right = box.right - ink.em();
  const float left = box.left + ink.em();
  const float done = left + (right - left) * static_cast<float>(source_.progress());
  ink.bar({left, box.bar}, {right, box.bar + 0.5f * ink.em()}, kFaint);
  ink.bar({left, box.bar}, {done, box.bar + 0.5f * ink.em()}, kAccent);
}

void TimelinePanel::use_mouse(const Box& box, ReplayPlayer& player) {
  ImGui::SetCursorScreenPos({box.bar_left, box.bar});
  ImGui::InvisibleButton(
      "bar", {std::max(1.0f, box.bar_right - box.bar_left), std::max(1.0f, box.bottom - box.bar)});
  const ImGuiIO& io = ImGui::GetIO();
  const bool is_over = ImGui::IsItemHovered();
  hover_px_.reset();
  hover_y_px_.reset();
  if (is_over || is_scrubbing_) {
    hover_px_ = std::clamp(io.MousePos.x, box.bar_left, box.bar_right);
    hover_y_px_ = io.MousePos.y;
  }
  if (is_over && io.MouseWheel != 0.0f) scale_->zoom(io.MouseWheel, io.MousePos.x);
  if (is_over && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Right)) scale_->show_all();
  if (ImGui::IsItemActive()) {
    if (!is_scrubbing_) was_playing_ = player.is_playing();
    is_scrubbing_ = true;
    player.set_playing(false);
    player.go_to(scale_->moment_at(io.MousePos.x));
  } else if (is_scrubbing_) {
    is_scrubbing_ = false;
    player.set_playing(was_playing_);
  }
}

void TimelinePanel::draw_controls(const Ink& ink, const Box& box, ReplayPlayer& player) {
  const float em = ink.em();
  float x = box.left + 0.6f * em;
  tip_ = Text::kCount;
  const auto button = [&](const char* name, Icon icon, Text does, bool is_on = false) {
    const bool is_pressed = ink.button(name, {x, box.controls}, icon, is_on);
    if (ImGui::IsItemHovered()) tip_ = does;
    x += 2.0f * em;
    return is_pressed;
  };
  if (button("start", Icon::kStart, Text::kTipStart)) player.go_to(player.index().begin);
  if (button("back5", Icon::kBack, Text::kTipBack)) player.jump(-kJump);
  if (button("frame-", Icon::kFrameBack, Text::kTipFrameBack)) player.step_frames(-1);
  if (button("play", player.is_playing() ? Icon::kPause : Icon::kPlay, Text::kDoPlay))
    player.toggle_playing();
  if (button("frame+", Icon::kFrameOn, Text::kTipFrameOn)) player.step_frames(1);
  if (button("on5", Icon::kOn, Text::kTipOn)) player.jump(kJump);
  x += 0.6f * em;
  if (button("begin", Icon::kLoopBegin, Text::kTipLoopBegin, player.loop_begin().has_value()))
    player.set_loop_begin();
  if (button("end", Icon::kLoopEnd, Text::kTipLoopEnd, player.loop_end().has_value()))
    player.set_loop_end();
  if (button("loop", Icon::kLoop, Text::kTipLoop, player.loops())) player.toggle_loop();
  x += 0.6f * em;
  if (button("slower", Icon::kMinus, Text::kTipSlower)) player.change_speed(-1);
  std::array<char, 16> speed{};
  std::snprintf(speed.data(), speed.size(), "%g×", player.speed());
  ink.middle(x + 1.1f * em, box.controls + 0.35f * em, kBright, speed.data());
  x += 2.3f * em;
  if (button("faster", Icon::kPlus, Text::kTipFaster)) player.change_speed(1);
  if (exporting_.start && button("export", Icon::kExport, Text::kTipExport, asks_what_to_export_))
    ask_about_export(!asks_what_to_export_);
  draw_words(ink, box, player, x + 0.6f * em);
}

// Above the timeline, where the mouse is on a button.
void TimelinePanel::draw_tip(const Ink& ink, const Box& box) const {
  if (tip_ == Text::kCount) return;
  const float em = ink.em();
  const float width = ink.width_of(texts_[tip_]);
  const float left = std::clamp(ImGui::GetIO().MousePos.x - 0.5f * width, box.left + em,
                                std::max(box.left + em, box.right - width - em));
  const float top = box.top - 2.2f * em;
  const Ink above{{*ImGui::GetForegroundDrawList(), ink.font()}};
  above.panel({left - 0.7f * em, top}, {left + width + 0.7f * em, top + 1.9f * em});
  above.left(left, top + 0.4f * em, kBright, texts_[tip_]);
}

void TimelinePanel::draw_words(const Ink& ink, const Box& box, const ReplayPlayer& player,
                               float left) const {
  const float em = ink.em();
  const float y = box.controls + 0.35f * em;
  const std::string time =
      clock_text(player.seconds(), 0.1) + " / " + clock_text(player.length_s(), 1.0);
  std::string music = bar_text(player.index().beats, player.position());
  if (const double tempo = tempo_at(player.index().beats, player.position()); tempo > 0.0)
    music += "   " + std::to_string(std::lround(tempo)) + " BPM";
  float right = box.right - 1.2f * em;
  ink.right(right, y, kBright, time.c_str());
  right -= ink.width_of(time.c_str()) + 1.6f * em;
  if (right - ink.width_of(music.c_str()) > left) {
    ink.right(right, y, kDim, music.c_str());
    right -= ink.width_of(music.c_str()) + 1.6f * em;
  }
  const std::string note = exporting_.note ? exporting_.note() : "";
  if (!note.empty() && right > left + 4.0f * em) ink.clipped(left, right, y, kAccent, note.c_str());
}

void TimelinePanel::draw_density(const Ink& ink, const Box& box) const {
  const ReplayIndex& index = *source_.index();
  const std::size_t parts = index.density.size();
  if (parts == 0) return;
  const double most = *std::max_element(index.density.begin(), index.density.end());
  if (!(most > 0.0)) return;
  const double part_s = (index.end - index.begin).as_seconds() / static_cast<double>(parts);
  const double from = (scale_->from() - index.begin).as_seconds() / std::max(part_s, 1e-9);
  const double to = (scale_->to() - index.begin).as_seconds() / std::max(part_s, 1e-9);
  const auto first =
      static_cast<std::size_t>(std::clamp(from, 0.0, static_cast<double>(parts - 1)));
  for (std::size_t i = first; i < parts && static_cast<double>(i) < to; ++i) {
    const auto x = [&](std::size_t part) {
      const MonoTime t = index.begin + Duration::seconds(part_s * static_cast<double>(part));
      return std::clamp(scale_->x_of(t), box.bar_left, box.bar_right);
    };
    const float height = (box.bar_bottom - box.bar) * 0.92f *
                         static_cast<float>(static_cast<double>(index.density[i]) / most);
    ink.list().AddRectFilled({x(i), box.bar_bottom - height}, {x(i + 1), box.bar_bottom}, kDensity);
  }
}

void TimelinePanel::draw_ticks(const Ink& ink, const Box& box) const {
  const float em = ink.em();
  const float height = box.bar_bottom - box.bar;
  for (const BeatTick& tick : beat_ticks(source_.index()->beats, *scale_, 0.5f * em, 3.2f * em)) {
    const float x = std::round(scale_->x_of(tick.time));
    const float top = tick.is_bar ? box.bar + 0.45f * height : box.bar + 0.75f * height;
    ink.list().AddRectFilled({x, top}, {x + std::max(1.0f, 0.07f * em), box.bar_bottom},
                             tick.is_bar ? kBarTick : kBeatTick);
    if (tick.has_label && x + 2.5f * em < box.bar_right)
      ink.left(x + 0.25f * em, box.bar + 0.05f * em, kDim, std::to_string(tick.bar).c_str());
  }
  // Times along the bottom.
  const double step_s = scale_->label_step_s(5.0f * em);
  const MonoTime begin = source_.index()->begin;
  const double first = std::ceil((scale_->from() - begin).as_seconds() / step_s - 1e-9);
  for (int k = 0; k < 1000; ++k) {
    const double s = (first + k) * step_s;
    const MonoTime t = begin + Duration::seconds(s);
    if (t > scale_->to()) break;
    const float x = std::round(scale_->x_of(t));
    ink.list().AddRectFilled({x, box.times}, {x + 1.0f, box.times + 0.35f * em}, kDim);
    const std::string text = clock_text(s, step_s);
    if (x + ink.width_of(text.c_str()) < box.right)
      ink.left(x + 0.3f * em, box.times, kDim, text.c_str());
  }
}

void TimelinePanel::draw_bar(const Ink& ink, const Box& box, const ReplayPlayer& player) const {
  const float em = ink.em();
  ink.bar({box.bar_left, box.bar}, {box.bar_right, box.bar_bottom}, kFaint);
  draw_density(ink, box);
  const auto x_within = [&](MonoTime t) {
    return std::clamp(scale_->x_of(t), box.bar_left, box.bar_right);
  };
  if (player.loop_begin() || player.loop_end()) {
    const ImU32 colour = player.loops() ? kLoopOn : kLoopOff;
    const float from = x_within(player.range_begin());
    const float to = x_within(player.range_end());
    ink.list().AddRectFilled({from, box.bar}, {to, box.times}, colour);
    for (const float x : {from, to})
      ink.list().AddRectFilled({x - 0.08f * em, box.bar - 0.2f * em}, {x + 0.08f * em, box.times},
                               kLoopEdge);
  }
  draw_ticks(ink, box);
  if (player.position() < scale_->from() || player.position() > scale_->to()) return;
  const float x = std::round(scale_->x_of(player.position()));
  ink.list().AddRectFilled({x - 0.06f * em, box.bar - 0.1f * em}, {x + 0.08f * em, box.times},
                           kBright);
  ink.list().AddTriangleFilled({x - 0.42f * em, box.bar - 0.45f * em},
                               {x + 0.42f * em, box.bar - 0.45f * em}, {x, box.bar + 0.15f * em},
                               kBright);
}

}  // namespace dance
