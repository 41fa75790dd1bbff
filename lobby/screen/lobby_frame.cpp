#include <imgui.h>

#include <algorithm>
#include <array>

#include "lobby/screen/lobby_screens.h"

namespace dance {
namespace {

constexpr float kRail_u = 236.0f;
constexpr float kContent_u = 900.0f;  // at most: longer lines are hard to read
constexpr float kMargin_u = 28.0f;

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
       {Place{LobbyScreen::kYou, Text::kLobbyYou}, Place{LobbyScreen::kDance, Text::kLobbyDance},
        Place{LobbyScreen::kHost, Text::kLobbyHost}}) {
    if (place.screen == LobbyScreen::kHost && !model.has_server) continue;
    if (kit.row(t[place.text], t[place.text], "", model.screen == place.screen))
      model.show(place.screen);
  }
  const float foot = kit.px(46.0f * 3.0f + 100.0f);
  ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY() + kit.px(10.0f), height_px - foot));
  for (const LanguageName& it : kLanguages) {
    const std::string name(it.name);
    const bool is_chosen = t.language() == it.language;
    if (kit.button(name.c_str(), is_chosen ? ButtonLook::kPlain : ButtonLook::kQuiet, 120.0f))
      model.set_language(it.language);
  }
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
    const char* button = banner.button == Text::kCount ? nullptr : model.texts[banner.button];
    const LobbyKit::Strip pressed =
        kit.strip(static_cast<int>(i), banner.kind == LobbyBanner::Kind::kTrouble, words,
                  banner.detail, button);
    if (pressed == LobbyKit::Strip::kNone) continue;
    if (pressed == LobbyKit::Strip::kButton) model.ask(banner.wish);
    model.banners.erase(model.banners.begin() + static_cast<std::ptrdiff_t>(i));
    return;
  }
}

void draw_content(LobbyModel& model, LobbyKit& kit, float width_px, float height_px) {
  const float room = width_px - kit.px(kRail_u);
  const float width = std::min(room, kit.px(kContent_u + 2.0f * kMargin_u));
  ImGui::SetCursorPos(ImVec2(kit.px(kRail_u) + std::max(0.0f, 0.5f * (room - width)), 0.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kit.px(kMargin_u), kit.px(24.0f)));
  // Each screen by itself: it begins at its top, and keeps where it was scrolled to.
  constexpr std::array<const char*, 3> kNames{"you", "dance", "host"};
  ImGui::BeginChild(kNames[static_cast<std::size_t>(model.screen)], ImVec2(width, height_px), false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NavFlattened);
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
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

// Over all the rest, in the middle.
bool begin_sheet(LobbyKit& kit, const char* id, float width_px, float height_px, float wide_u,
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
  if (!begin_sheet(kit, "going in", width_px, height_px, 420.0f, 210.0f)) return;
  kit.title(model.texts[Text::kLobbyGoingIn]);
  kit.note(model.texts[Text::kLobbyGoingInNote]);
  kit.gap(8.0f);
  if (kit.button(model.texts[Text::kLobbyCancel]) ||
      ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
    model.ask(LobbyWish::kCancel);
  ImGui::EndPopup();
}

}  // namespace

void draw_command(LobbyModel& model, LobbyKit& kit, LobbyWish wish) {
  const Texts& t = model.texts;
  ImGui::PushID(static_cast<int>(wish));
  const bool is_shown = model.shows_command && model.command_for == wish;
  const char* words = t[is_shown ? Text::kLobbyHideCommand : Text::kLobbyShowCommand];
  if (kit.small_button(words)) {
    model.shows_command = !is_shown;
    model.command_for = wish;
  }
  if (is_shown) {
    kit.note(t[Text::kLobbyCommandNote]);
    const std::string line = model.command(wish);
    kit.box(line);
    if (kit.button(t[Text::kLobbyCopy])) ImGui::SetClipboardText(line.c_str());
  }
  ImGui::PopID();
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
  } else if (model.chooser.is_open()) {
    if (begin_sheet(kit, "choose", width_px, height_px, 720.0f, 620.0f)) {
      draw_file_chooser(model, kit);
      ImGui::EndPopup();
    }
  }
  ImGui::End();
}

}  // namespace dance
