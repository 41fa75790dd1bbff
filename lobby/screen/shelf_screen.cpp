#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <iomanip>
#include <sstream>

#include "core/base/text/plain_text.h"
#include "lobby/screen/lobby_screens.h"
#include "lobby/shelf/dance_folder.h"

namespace dance {
namespace {

using Question = ShelfFacts::Question;

constexpr std::size_t kMostShownGuests = 4;  // the others are counted

std::tm local_time(std::int64_t us) {
  const std::time_t seconds = static_cast<std::time_t>(us / 1'000'000);
  std::tm local{};
  localtime_r(&seconds, &local);
  return local;
}

std::string time_text(const std::tm& local, const char* format) {
  std::ostringstream text;
  text << std::put_time(&local, format);
  return text.str();
}

bool is_same_day(const std::tm& a, const std::tm& b) {
  return a.tm_year == b.tm_year && a.tm_yday == b.tm_yday;
}

std::string when_words(const Texts& t, std::int64_t begun_us, std::int64_t now_us) {
  constexpr std::int64_t kDay_us = 86'400'000'000;
  const std::tm begun = local_time(begun_us);
  if (is_same_day(begun, local_time(now_us)))
    return t.say(Text::kLobbyToday, {time_text(begun, "%H:%M")});
  if (is_same_day(begun, local_time(now_us - kDay_us)))
    return t.say(Text::kLobbyYesterday, {time_text(begun, "%H:%M")});
  return time_text(begun, t[Text::kLobbyDateFormat]);
}

std::string length_words(Duration length) {
  const auto seconds = static_cast<long>(length.as_seconds() + 0.5);
  std::array<char, 32> text{};
  if (seconds >= 3600)
    std::snprintf(text.data(), text.size(), "%ld:%02ld:%02ld", seconds / 3600, seconds / 60 % 60,
                  seconds % 60);
  else
    std::snprintf(text.data(), text.size(), "%ld:%02ld", seconds / 60, seconds % 60);
  return text.data();
}

std::string guest_words(const RecordedDance& dance) {
  std::string names;
  for (std::size_t i = 0; i < std::min(dance.guests.size(), kMostShownGuests); ++i)
    names += (i == 0 ? "" : ", ") + dance.shown(dance.guests[i]);
  if (dance.guests.size() > kMostShownGuests)
    names += " +" + std::to_string(dance.guests.size() - kMostShownGuests);
  return names;
}

void add_part(std::string& line, const std::string& part) {
  if (part.empty()) return;
  line += (line.empty() ? "" : "   ") + part;
}

std::string first_line(const LobbyModel& model, const RecordedDance& dance) {
  std::string line = when_words(model.texts, dance.begun_us, model.shelf.now_us);
  add_part(line, guest_words(dance));
  return line;
}

std::string second_line(const LobbyModel& model, const RecordedDance& dance) {
  const Texts& t = model.texts;
  std::string line;
  if (dance.is_read && !dance.has_motion) add_part(line, t[Text::kLobbyNoDanceInIt]);
  if (dance.length > Duration()) add_part(line, length_words(dance.length));
  add_part(line, dance.song);
  if (dance.tempo_bpm > 0.0) {
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "%.0f", dance.tempo_bpm);
    add_part(line, t.say(Text::kLobbyTempo, {number.data()}));
  }
  add_part(line, dance.name());
  return line;
}

void request_button(LobbyModel& model, LobbyKit& kit, Text words, LobbyWish wish,
                    ButtonLook look = ButtonLook::kPlain) {
  kit.beside(model.texts[words]);
  if (kit.button(model.texts[words], look)) model.ask(wish);
}

void question_button(LobbyModel& model, LobbyKit& kit, Text words, Question question) {
  ShelfFacts& shelf = model.shelf;
  kit.beside(model.texts[words]);
  const bool is_asked = shelf.question == question;
  if (!kit.choice(model.texts[words], is_asked)) return;
  shelf.question = is_asked ? Question::kNone : question;
  const RecordedDance* dance = shelf.find_chosen();
  if (dance != nullptr) shelf.name_typed = dance->name();
}

void draw_rename(LobbyModel& model, LobbyKit& kit) {
  kit.label(model.texts[Text::kLobbyNewName]);
  kit.field("##newname", model.shelf.name_typed, 420.0f, kMostDanceName_bytes);
  kit.beside(model.texts[Text::kLobbyRename]);
  ImGui::PushID("rename");
  if (kit.button(model.texts[Text::kLobbyRename], ButtonLook::kAccent))
    model.ask(LobbyWish::kRename);
  ImGui::PopID();
}

void draw_delete(LobbyModel& model, LobbyKit& kit, const RecordedDance& dance) {
  kit.text(model.texts.say(Text::kLobbyAskDelete, {dance.name()}));
  if (kit.button(model.texts[Text::kLobbyCancel])) model.shelf.question = Question::kNone;
  ImGui::PushID("delete");
  request_button(model, kit, Text::kLobbyDelete, LobbyWish::kDelete, ButtonLook::kAccent);
  ImGui::PopID();
}

void draw_file(LobbyModel& model, LobbyKit& kit, const RecordedDance& dance) {
  kit.box(plain_text(dance.path));
  // Copies what is shown: a line break in a name could start a command where it is pasted.
  if (kit.button(model.texts[Text::kLobbyCopy]))
    ImGui::SetClipboardText(plain_text(dance.path).c_str());
  if (model.shelf.has_opener)
    request_button(model, kit, Text::kLobbyOpenFolder, LobbyWish::kOpenFolder);
}

void draw_export(LobbyModel& model, LobbyKit& kit) {
  kit.note(model.texts[Text::kLobbyExportNote]);
  if (kit.button("BVH")) model.ask(LobbyWish::kExportBvh);
  kit.beside("GLB");
  if (kit.button("GLB")) model.ask(LobbyWish::kExportGlb);
}

void draw_chosen(LobbyModel& model, LobbyKit& kit, const RecordedDance& dance) {
  const Texts& t = model.texts;
  const bool can_export = dance.has_motion && model.shelf.exported_name.empty();
  ImGui::BeginDisabled(!dance.has_motion);
  if (kit.button(t[Text::kLobbyWatch], ButtonLook::kAccent, 120.0f)) model.ask(LobbyWish::kWatch);
  ImGui::EndDisabled();
  ImGui::BeginDisabled(!can_export);
  if (model.shelf.has_video)
    request_button(model, kit, Text::kLobbyMakeVideo, LobbyWish::kMakeVideo);
  question_button(model, kit, Text::kLobbyExport, Question::kExport);
  ImGui::EndDisabled();
  ImGui::BeginDisabled(!dance.has_motion);
  kit.beside(t[Text::kLobbyDanceBeside]);
  if (kit.button(t[Text::kLobbyDanceBeside])) {
    model.settings.window.teacher = dance.path;
    model.ask(LobbyWish::kPractise);
  }
  ImGui::EndDisabled();
  question_button(model, kit, Text::kLobbyRename, Question::kRename);
  question_button(model, kit, Text::kLobbyDelete, Question::kDelete);
  question_button(model, kit, Text::kLobbyShowFile, Question::kFile);
  switch (model.shelf.question) {
    case Question::kNone:
      break;
    case Question::kExport:
      if (can_export) draw_export(model, kit);
      break;
    case Question::kRename:
      draw_rename(model, kit);
      break;
    case Question::kDelete:
      draw_delete(model, kit, dance);
      break;
    case Question::kFile:
      draw_file(model, kit, dance);
      break;
  }
}

void draw_progress(LobbyModel& model, LobbyKit& kit) {
  const ShelfFacts& shelf = model.shelf;
  if (shelf.exported_name.empty()) return;
  kit.begin_card(nullptr);
  std::string words = model.texts.say(Text::kLobbyExporting, {plain_text(shelf.exported_name)});
  if (shelf.percent >= 0) words += " " + std::to_string(shelf.percent) + " %";
  kit.text(words);
  if (shelf.percent >= 0) {
    const float share = 0.01f * static_cast<float>(shelf.percent);
    kit.meter(share, share);
  }
  if (kit.button(model.texts[Text::kLobbyCancel])) model.ask(LobbyWish::kCancelExport);
  kit.end_card();
}

}  // namespace

void draw_shelf_screen(LobbyModel& model, LobbyKit& kit) {
  ShelfFacts& shelf = model.shelf;
  kit.title(model.texts[Text::kLobbyShelfTitle]);
  kit.gap(2.0f);
  draw_progress(model, kit);
  kit.begin_card(nullptr);
  if (shelf.dances.empty()) kit.note(model.texts.say(Text::kLobbyShelfEmpty, {shelf.folder}));
  for (const RecordedDance& dance : shelf.dances) {
    const bool is_chosen = dance.path == shelf.chosen;
    if (kit.row(dance.path.c_str(), first_line(model, dance), second_line(model, dance),
                is_chosen)) {
      shelf.chosen = is_chosen ? "" : dance.path;
      shelf.question = Question::kNone;
    }
    if (!is_chosen) continue;
    ImGui::PushID("chosen");
    draw_chosen(model, kit, dance);
    ImGui::PopID();
  }
  kit.end_card();
}

}  // namespace dance
