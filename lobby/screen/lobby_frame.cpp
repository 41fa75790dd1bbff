#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lobby/screen/lobby_screens.h"

namespace dance {
namespace {

constexpr float kRail_u = 236.0f;
constexpr float kContent_u = 900.0f;  // at most: longer lines are hard to read
constexpr float kMargin_u = 28.0f;

// Two buttons with a small and a large A: smaller and larger letters.
void draw_letter_size(LobbyModel& model, LobbyKit& kit) {
  constexpr double kStep = 1.1;
  double& letters = model.settings.window.letters;
  const auto change = [&](double by) {
    letters = std::clamp(std::round(100.0 * letters * by) / 100.0, WindowChoices::kSmallestLetters,
                         WindowChoices::kLargestLetters);
    if (std::abs(letters - 1.0) < 0.04) letters = 1.0;
  };
  if (kit.small_button("A##smaller")) change(1.0 / kStep);
  ImGui::SameLine();
  ImGui::PushFont(kit.fonts().title);
  const bool is_larger = kit.button("A##larger", ButtonLook::kQuiet);
  ImGui::PopFont();
  if (is_larger) change(kStep);
}

void draw_rail(LobbyModel& model, LobbyKit& kit, float height_px) {
  const Texts& t = model.texts;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kit.px(18.0f), kit.px(24.0f)));
  ImGui::BeginChild("rail", ImVec2(kit.px(kRail_u), height_px), false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NavFlattened |
                        ImGuiWindowFlags_NoScrollbar);
  kit.title("DanceGraph");
  kit.gap(14.0f);
  struct Place {
    LobbyScreen screen;
    Text text;
  };
  for (const Place& place :
       {Place{LobbyScreen::kDance, Text::kLobbyDance}, Place{LobbyScreen::kYou, Text::kLobbyYou},
        Place{LobbyScreen::kHost, Text::kLobbyHost},
        Place{LobbyScreen::kShelf, Text::kLobbyShelf}}) {
    if (place.screen == LobbyScreen::kHost && !model.has_server) continue;
    if (kit.row(t[place.text], t[place.text], "", model.screen == place.screen))
      model.show(place.screen);
  }
  const float foot = kit.px(46.0f * 3.0f + 144.0f);
  ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY() + kit.px(10.0f), height_px - foot));
  for (const LanguageName& it : kLanguages) {
    const std::string name(it.name);
    const bool is_chosen = t.language() == it.language;
    if (kit.button(name.c_str(), is_chosen ? ButtonLook::kPlain : ButtonLook::kQuiet, 120.0f))
      model.set_language(it.language);
  }
  draw_letter_size(model, kit);
  kit.note(t[Text::kLobbyKeysHint]);
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

void draw_banners(LobbyModel& model, LobbyKit& kit) {
  for (std::size_t i = 0; i < model.banners.size(); ++i) {
    const LobbyBanner& banner = model.banners[i];
    std::string words = model.texts[banner.text];
    for (const std::string& value : banner.values)
      if (const std::size_t at = words.find("{}"); at != std::string::npos)
        words.replace(at, 2, value);
    const auto words_of = [&](Text button) {
      return button == Text::kCount ? nullptr : model.texts[button];
    };
    const LobbyKit::Strip pressed =
        kit.strip(static_cast<int>(i), banner.kind == LobbyBanner::Kind::kTrouble, words,
                  banner.detail, words_of(banner.button), words_of(banner.other_button));
    if (pressed == LobbyKit::Strip::kNone) continue;
    if (pressed == LobbyKit::Strip::kButton) model.ask(banner.wish);
    if (pressed == LobbyKit::Strip::kOtherButton) model.ask(banner.other_request);
    model.banners.erase(model.banners.begin() + static_cast<std::ptrdiff_t>(i));
    return;
  }
}

void draw_content(LobbyModel& model, LobbyKit& kit, float width_px, float height_px) {
  const float room = width_px - kit.px(kRail_u);
  const float width = std::min(room, kit.px(kContent_u + 2.0f * kMargin_u));
  ImGui::SetCursorPos(ImVec2(kit.px(kRail_u) + std::max(0.0f, 0.5f * (room - width)), 0.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kit.px(kMargin_u), kit.px(24.0f)));
  // Each screen scrolls by itself.
  constexpr std::array<const char*, 4> kNames{"you", "dance", "host", "shelf"};
  ImGui::BeginChild(kNames[static_cast<std::size_t>(model.screen)], ImVec2(width, height_px), false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NavFlattened);
  if (std::exchange(model.is_at_top, false)) ImGui::SetScrollY(0.0f);
  draw_banners(model, kit);
  switch (model.screen) {
    case LobbyScreen::kYou:
      draw_you_screen(model, kit);
      break;
    case LobbyScreen::kDance:
      draw_dance_screen(model, kit);
      break;
    case LobbyScreen::kHost:
      draw_host_screen(model, kit);
      break;
    case LobbyScreen::kShelf:
      draw_shelf_screen(model, kit);
      break;
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

// Over all the rest, in the middle.
bool begin_dialog(LobbyKit& kit, const char* id, float width_px, float height_px, float wide_u,
                  float high_u) {
  ImGui::OpenPopup(id);
  const ImVec2 size(std::min(kit.px(wide_u), 0.94f * width_px),
                    std::min(kit.px(high_u), 0.92f * height_px));
  ImGui::SetNextWindowPos({0.5f * (width_px - size.x), 0.5f * (height_px - size.y)});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kit.px(24.0f), kit.px(22.0f)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, kit.px(14.0f));
  const bool is_open =
      ImGui::BeginPopupModal(id, nullptr,
                             ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
  return is_open;
}

void draw_going_in(LobbyModel& model, LobbyKit& kit, float width_px, float height_px) {
  if (!begin_dialog(kit, "going in", width_px, height_px, 420.0f, 210.0f)) return;
  kit.title(model.texts[Text::kLobbyGoingIn]);
  kit.note(model.texts[Text::kLobbyGoingInNote]);
  kit.gap(8.0f);
  if (kit.button(model.texts[Text::kLobbyCancel]) ||
      ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
    model.ask(LobbyWish::kCancel);
  ImGui::EndPopup();
}

// Cancel has the focus, so that a key pressed for another window confirms nothing.
void draw_join_request(LobbyModel& model, LobbyKit& kit, float width_px, float height_px) {
  JoinRequest& request = *model.join_request;
  // A long host name takes more lines, of 20 units and at least 30 characters each.
  const std::size_t letters = request.room.size() + request.server.size() + request.guest.size();
  const float high_u =
      (request.has_new_key ? 390.0f : 330.0f) + 20.0f * static_cast<float>(letters / 30);
  if (!begin_dialog(kit, "join request", width_px, height_px, 560.0f, high_u)) return;
  const Texts& t = model.texts;
  kit.title(t[Text::kLobbyInvitation]);
  kit.gap(2.0f);
  kit.text(t.say(Text::kLobbyAskJoin, {request.room, request.server, request.guest}));
  kit.text(t[request.watches_only ? Text::kLobbyAskWatch
             : request.speaks     ? Text::kLobbyAskMotionAndVoice
                                  : Text::kLobbyAskMotion]);
  if (model.has_voice && !request.watches_only) {
    kit.label(t[Text::kLobbyMicrophone]);
    if (kit.choice(t[Text::kLobbyYes], request.speaks)) request.speaks = true;
    kit.beside(t[Text::kLobbyNo]);
    if (kit.choice(t[Text::kLobbyNo], !request.speaks)) request.speaks = false;
  }
  kit.note(t[request.has_new_key ? Text::kLobbyAskNewKey : Text::kLobbyAskNew]);
  kit.gap(6.0f);
  if (kit.button(t[Text::kLobbyCancel], ButtonLook::kPlain, 140.0f) ||
      ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
    model.ask(LobbyWish::kCancel);
  ImGui::SetItemDefaultFocus();
  kit.beside(t[Text::kLobbyJoin], 140.0f);
  if (kit.button(t[Text::kLobbyJoin], ButtonLook::kAccent, 140.0f))
    model.ask(LobbyWish::kConfirmJoin);
  ImGui::EndPopup();
}

}  // namespace

void draw_commands(LobbyModel& model, LobbyKit& kit, std::initializer_list<CommandOf> commands) {
  const Texts& t = model.texts;
  const char* words = t[model.shows_command ? Text::kLobbyHideCommand : Text::kLobbyShowCommand];
  if (kit.small_button(words)) model.shows_command = !model.shows_command;
  if (!model.shows_command) return;
  kit.begin_card(nullptr);
  kit.note(t[Text::kLobbyCommandNote]);
  for (const CommandOf& it : commands) {
    ImGui::PushID(static_cast<int>(it.wish));
    const std::string line = model.command(it.wish);
    if (commands.size() > 1) kit.note(t[it.button]);
    kit.box(line);
    if (kit.small_button(t[Text::kLobbyCopy])) ImGui::SetClipboardText(line.c_str());
    ImGui::PopID();
  }
  kit.end_card();
}

void draw_lobby(LobbyModel& model, LobbyKit& kit, float width_px, float height_px) {
  kit.apply_style();
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({width_px, height_px});
  ImGui::Begin("lobby", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::GetWindowDrawList()->AddRectFilled({0.0f, 0.0f}, {kit.px(kRail_u), height_px},
                                            IM_COL32(14, 16, 21, 255));
  draw_rail(model, kit, height_px);
  draw_content(model, kit, width_px, height_px);
  if (model.is_going_in) {
    draw_going_in(model, kit, width_px, height_px);
  } else if (model.join_request) {
    draw_join_request(model, kit, width_px, height_px);
  } else if (model.chooser.is_open()) {
    if (begin_dialog(kit, "choose", width_px, height_px, 720.0f, 620.0f)) {
      draw_file_chooser(model, kit);
      ImGui::EndPopup();
    }
  }
  ImGui::End();
}

}  // namespace dance
