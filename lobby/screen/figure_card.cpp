// The card of the page You for choosing a figure by its picture.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "formats/body/random_look.h"
#include "lobby/screen/lobby_screens.h"
#include "lobby/settings/chosen_look.h"

namespace dance {
namespace {

constexpr double kLeastHeight_m = 0.8, kMostHeight_m = 2.5, kUsualHeight_m = 1.7;
// Range of the buttons for the figure's height, relative to the dancer. A house file may exceed it.
constexpr double kLeastShare = 0.5, kMostShare = 1.5;
constexpr float kBesidePicture_u = 330.0f;  // with less room the choices are below the picture

std::string figure_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

// Returns -1, 0 or 1.
int draw_minus_and_plus(LobbyKit& kit) {
  int by = 0;
  ImGui::PushButtonRepeat(true);
  if (kit.button("-")) by = -1;
  ImGui::SameLine();
  if (kit.button("+")) by = 1;
  ImGui::PopButtonRepeat();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  return by;
}

// The camera needs the dancer's height for its scale.
void draw_dancers_height(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  double& height_m = model.settings.height_m;
  kit.label(t[Text::kLobbyYourHeight]);
  ImGui::PushID("dancer");
  if (const int by = draw_minus_and_plus(kit); by != 0) {
    const double from_m = height_m > 0.0 ? height_m + 0.01 * by : kUsualHeight_m;
    // Rounded to whole centimetres, even if the file has fractions.
    height_m = std::clamp(std::round(100.0 * from_m) / 100.0, kLeastHeight_m, kMostHeight_m);
  }
  ImGui::PopID();
  std::array<char, 16> metres{};
  std::snprintf(metres.data(), metres.size(), "%.2f", height_m);
  kit.text(height_m > 0.0 ? t.say(Text::kLobbyHeightMetres, {metres.data()})
                          : std::string(t[Text::kLobbyHeightNotSaid]));
}

void draw_figures_height(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  double& share = model.settings.figure_height;
  kit.label(t[Text::kFigureHeight]);
  ImGui::PushID("figure");
  if (const int by = draw_minus_and_plus(kit); by != 0)
    share = std::clamp(std::round(100.0 * share + by) / 100.0, kLeastShare, kMostShare);
  ImGui::PopID();
  const std::string percent = std::to_string(std::lround(100.0 * share));
  kit.text(share == 1.0 ? std::string(t[Text::kFigureAsYou])
                        : t.say(Text::kFigureOfYours, {percent}));
}

void draw_options(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& avatar = model.settings.avatar;
  bool is_first = true;
  for (const FigureOption& option : model.figures.options) {
    std::string words = option.name;
    if (option.avatar.empty())
      words = t[Text::kLobbyMannequin];
    else if (words.empty())
      words = t[Text::kFigureStored];
    const float edge = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float width = kit.px(FigureFacts::kPortraitWidth_u + 10.0f);
    if (!is_first && ImGui::GetItemRectMax().x + width + kit.px(18.0f) < edge) ImGui::SameLine();
    is_first = false;
    if (kit.picture_choice(option.avatar.c_str(), option.texture, words,
                           FigureFacts::kPortraitWidth_u, FigureFacts::kPortraitHeight_u,
                           avatar == option.avatar))
      avatar = option.avatar;
  }
}

template <class Value, std::size_t kCount>
bool draw_clothes(LobbyModel& model, LobbyKit& kit, Text label,
                  const std::array<std::pair<Value, Text>, kCount>& choices, Value& chosen) {
  const Texts& t = model.texts;
  bool has_changed = false, is_first = true;
  kit.label(t[label]);
  ImGui::PushID(static_cast<int>(label));
  for (const auto& [value, words] : choices) {
    if (!is_first) kit.beside(t[words]);
    is_first = false;
    if (!kit.choice(t[words], chosen == value)) continue;
    chosen = value;
    has_changed = true;
  }
  ImGui::PopID();
  return has_changed;
}

// Returns the index of the clicked colour; -1 = none.
template <std::size_t kCount>
int draw_swatches(LobbyModel& model, LobbyKit& kit, Text label,
                  const std::array<std::uint32_t, kCount>& palette, const Eigen::Vector3f& chosen) {
  int clicked = -1;
  kit.label(model.texts[label]);
  ImGui::PushID(static_cast<int>(label));
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool is_chosen = linear_from_srgb(palette[i]).isApprox(chosen, 1e-3f);
    const std::string id = std::to_string(i);
    if (kit.swatch(id.c_str(), palette[i], is_chosen)) clicked = static_cast<int>(i);
  }
  ImGui::PopID();
  ImGui::NewLine();
  return clicked;
}

void choose_any_look(LobbySettings& settings) {
  const auto seed = static_cast<std::uint64_t>(ImGui::GetFrameCount());
  const RandomLook random = random_look(chosen_look(settings), seed);
  choose_look(random.look, settings);
  choose_top(random.top, settings);
}

void draw_look(LobbyModel& model, LobbyKit& kit) {
  LobbySettings& settings = model.settings;
  GuestLook look = chosen_look(settings);
  constexpr std::array kLegs{std::pair{Legwear::kTrousers, Text::kFigureTrousers},
                             std::pair{Legwear::kFlared, Text::kFigureFlared},
                             std::pair{Legwear::kSkirt, Text::kFigureDress}};
  constexpr std::array kSleeves{std::pair{Sleeves::kNone, Text::kFigureNoSleeves},
                                std::pair{Sleeves::kShort, Text::kFigureShortSleeves},
                                std::pair{Sleeves::kLong, Text::kFigureLongSleeves}};
  constexpr std::array kHairs{
      std::pair{Hair::kShort, Text::kFigureShortHair}, std::pair{Hair::kBob, Text::kFigureBob},
      std::pair{Hair::kBun, Text::kFigureBun}, std::pair{Hair::kPonytail, Text::kFigurePonytail}};
  bool has_changed = draw_clothes(model, kit, Text::kFigureLegs, kLegs, look.legwear);
  has_changed |= draw_clothes(model, kit, Text::kFigureSleeves, kSleeves, look.sleeves);
  has_changed |= draw_clothes(model, kit, Text::kFigureHair, kHairs, look.hair_style);
  const int skin = draw_swatches(model, kit, Text::kFigureSkin, kSkinColours, look.skin);
  if (skin >= 0) look.skin = linear_from_srgb(kSkinColours[static_cast<std::size_t>(skin)]);
  const int hair = draw_swatches(model, kit, Text::kFigureHairColour, kHairColours, look.hair);
  if (hair >= 0) look.hair = linear_from_srgb(kHairColours[static_cast<std::size_t>(hair)]);
  if (has_changed || skin >= 0 || hair >= 0) choose_look(look, settings);
  const int top = draw_swatches(model, kit, Text::kFigureColour, kTopColours, look.top);
  if (top >= 0) choose_top(kTopColours[static_cast<std::size_t>(top)], settings);
  if (kit.button(model.texts[Text::kFigureSurprise])) choose_any_look(settings);
}

}  // namespace

void draw_figure_card(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& avatar = model.settings.avatar;
  kit.begin_card(t[Text::kLobbyYourFigure]);
  const float picture = kit.px(FigureFacts::kChosenWidth_u);
  const bool is_wide = kit.room_px() > picture + kit.px(kBesidePicture_u);
  ImGui::BeginGroup();
  kit.picture(model.figures.chosen_texture, picture, kit.px(FigureFacts::kChosenHeight_u));
  if (is_wide) {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + picture);
    ImGui::TextUnformatted(
        t[model.figures.is_unreadable ? Text::kFigureUnreadable : Text::kFigureSeen]);
    ImGui::PopTextWrapPos();
  }
  ImGui::EndGroup();
  if (is_wide) ImGui::SameLine(0.0f, kit.px(16.0f));
  ImGui::BeginGroup();
  if (!is_wide)
    kit.text(t[model.figures.is_unreadable ? Text::kFigureUnreadable : Text::kFigureSeen]);
  draw_options(model, kit);
  const bool is_file = avatar.find('/') != std::string::npos;
  const std::string own = is_file ? figure_name(avatar) : std::string(t[Text::kLobbyOwnFigure]);
  const std::string shown = LobbyKit::shortened(own, kit.px(260.0f)) + "##own";
  if (kit.choice(shown.c_str(), is_file))
    model.chooser.open(ChooserPurpose::kAvatar, is_file ? avatar : "");
  if (avatar.empty()) draw_look(model, kit);
  draw_figures_height(model, kit);
  if (model.settings.source == DancerSource::kCamera) draw_dancers_height(model, kit);
  ImGui::EndGroup();
  kit.end_card();
}

}  // namespace dance
