#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "lobby/screen/lobby_screens.h"

namespace dance {
namespace {

constexpr double kLeastHeight_m = 0.8, kMostHeight_m = 2.5, kUsualHeight_m = 1.7;

std::string file_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

void draw_name(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  kit.begin_card(nullptr);
  kit.label(t[Text::kLobbyYourName]);
  if (kit.field("##name", model.name_typed, 260.0f, kMaxGuestIdLength)) {
    const std::string name = name_from(model.name_typed);
    if (!name.empty()) model.settings.name = name;
  }
  if (model.name_typed != model.settings.name) {
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    kit.note(model.settings.name);
  }
  kit.end_card();
}

void draw_height(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  double& height_m = model.settings.height_m;
  kit.label(t[Text::kLobbyYourHeight]);
  const auto step = [&](double by_m) {
    const double from_m = height_m > 0.0 ? height_m : kUsualHeight_m - by_m;
    // In whole centimetres, whatever stood in the file.
    height_m =
        std::clamp(std::round(100.0 * (from_m + by_m)) / 100.0, kLeastHeight_m, kMostHeight_m);
  };
  ImGui::PushButtonRepeat(true);
  if (kit.button("-")) step(-0.01);
  ImGui::SameLine();
  if (kit.button("+")) step(0.01);
  ImGui::PopButtonRepeat();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  std::array<char, 16> metres{};
  std::snprintf(metres.data(), metres.size(), "%.2f", height_m);
  kit.text(height_m > 0.0 ? t.say(Text::kLobbyHeightMetres, {metres.data()})
                          : std::string(t[Text::kLobbyHeightNotSaid]));
}

void draw_preview(LobbyModel& model, LobbyKit& kit) {
  if (model.preview_texture != nullptr) {
    const float width = std::min(kit.room_px() - kit.px(18.0f), kit.px(480.0f));
    ImGui::Image(model.preview_texture, ImVec2(width, width / model.preview_aspect));
  }
  for (const Text advice : model.advice) kit.text(model.texts[advice]);
}

void draw_camera(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  draw_preview(model, kit);
  if (model.cameras.empty() && model.knows_cameras)
    kit.text(t[model.has_camera ? Text::kLobbyNoCamera : Text::kLobbyNoCameraBuilt]);
  if (model.cameras.size() > 1 &&
      kit.row("first", t[Text::kLobbyFirstCamera], "", model.settings.camera.empty()))
    model.settings.camera.clear();
  for (const CameraFact& camera : model.cameras) {
    const bool is_chosen = model.settings.camera == camera.path ||
                           (model.cameras.size() == 1 && model.settings.camera.empty());
    const std::string& more = camera.trouble.empty() ? camera.path : camera.trouble;
    if (kit.row(camera.path.c_str(), camera.name.empty() ? camera.path : camera.name, more,
                is_chosen))
      model.settings.camera = camera.path;
  }
  if (model.has_camera && kit.button(t[Text::kLobbyLookAgain])) model.ask(LobbyWish::kLookAgain);
  draw_height(model, kit);
}

void draw_motion_file(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  const std::string& file = model.settings.motion_file;
  if (kit.row("file", file.empty() ? t[Text::kLobbyNothingChosen] : file_name(file), file, false))
    model.chooser.open(ChooserPurpose::kMotion, file);
}

void draw_source(LobbyModel& model, LobbyKit& kit) {
  using enum DancerSource;
  const Texts& t = model.texts;
  DancerSource& source = model.settings.source;
  kit.begin_card(t[Text::kLobbyWhoDances]);
  struct Place {
    DancerSource source;
    Text text;
  };
  constexpr std::array kPlaces{
      Place{kCamera, Text::kLobbyFromCamera}, Place{kHeadset, Text::kLobbyFromHeadset},
      Place{kFile, Text::kLobbyFromFile}, Place{kSynthetic, Text::kLobbyFromNobody},
      Place{kElsewhere, Text::kLobbyFromElsewhere}};
  bool is_first = true;
  for (const Place& place : kPlaces) {
    if (place.source == kElsewhere && source != kElsewhere) continue;
    if (place.source == kCamera && !model.has_camera && source != kCamera) continue;
    if (place.source == kHeadset && !model.has_headset && source != kHeadset) continue;
    if (!is_first) kit.beside(t[place.text]);
    is_first = false;
    if (!kit.choice(t[place.text], source == place.source)) continue;
    // Nothing dances from a file that was not chosen yet.
    if (place.source == kFile && model.settings.motion_file.empty())
      model.chooser.open(ChooserPurpose::kMotion, "");
    else
      source = place.source;
  }
  kit.gap(4.0f);
  if (source == kCamera) draw_camera(model, kit);
  if (source == kHeadset)
    kit.text(t[model.has_headset ? Text::kLobbyHeadsetHow : Text::kLobbyNoHeadsetBuilt]);
  if (source == kFile) draw_motion_file(model, kit);
  if (source == kSynthetic) {
    if (kit.choice(t[Text::kLobbyLeads], model.settings.leads)) model.settings.leads = true;
    kit.beside(t[Text::kLobbyFollows]);
    if (kit.choice(t[Text::kLobbyFollows], !model.settings.leads)) model.settings.leads = false;
  }
  kit.end_card();
}

void draw_figure(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& avatar = model.settings.avatar;
  kit.begin_card(t[Text::kLobbyYourFigure]);
  if (kit.choice(t[Text::kLobbyMannequin], avatar.empty())) avatar.clear();
  for (const std::string& name : model.avatars) {
    kit.beside(name.c_str());
    if (kit.choice(name.c_str(), avatar == name)) avatar = name;
  }
  const bool is_file = avatar.find('/') != std::string::npos;
  const std::string own = is_file ? file_name(avatar) : std::string(t[Text::kLobbyOwnFigure]);
  const std::string shown = LobbyKit::shortened(own, kit.px(300.0f)) + "##own";
  kit.beside(shown.c_str());
  if (kit.choice(shown.c_str(), is_file)) model.chooser.open(ChooserPurpose::kAvatar, avatar);
  kit.end_card();
}

void draw_yes_or_no(const Texts& t, LobbyKit& kit, Text question, bool& answer) {
  ImGui::PushID(static_cast<int>(question));
  kit.text(t[question]);
  ImGui::SameLine(kit.px(300.0f));
  if (kit.choice(t[Text::kLobbyYes], answer)) answer = true;
  ImGui::SameLine();
  if (kit.choice(t[Text::kLobbyNo], !answer)) answer = false;
  ImGui::PopID();
}

void draw_devices(LobbyKit& kit, const Texts& t, Text heading,
                  const std::vector<SoundDevice>& devices, std::string& chosen) {
  kit.note(t[heading]);
  ImGui::PushID(static_cast<int>(heading));
  if (kit.row("usual", t[Text::kLobbyUsualDevice], "", chosen.empty())) chosen.clear();
  for (const SoundDevice& device : devices)
    if (kit.row(device.name.c_str(), device.description, "", chosen == device.name))
      chosen = device.name;
  ImGui::PopID();
}

void draw_sound_test(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  SoundFacts& sound = model.sound;
  const Text words = sound.is_tested ? Text::kLobbyEndTestSound : Text::kLobbyTestSound;
  if (kit.button(t[words])) sound.is_tested = !sound.is_tested;
  if (!sound.is_tested) return;
  kit.beside(t[Text::kLobbyPlayCountIn]);
  if (kit.button(t[Text::kLobbyPlayCountIn])) model.ask(LobbyWish::kPlayCountIn);
  kit.meter(sound.level, sound.held);
  for (const Text advice : sound.advice) kit.text(t[advice]);
  draw_devices(kit, t, Text::kLobbyMicrophone, sound.microphones, model.settings.microphone);
  draw_devices(kit, t, Text::kLobbyLoudspeaker, sound.loudspeakers, model.settings.loudspeaker);
}

void draw_voice(LobbyModel& model, LobbyKit& kit) {
  kit.begin_card(model.texts[Text::kLobbyVoice]);
  draw_yes_or_no(model.texts, kit, Text::kLobbyTalk, model.settings.speaks);
  if (model.settings.speaks) {
    draw_yes_or_no(model.texts, kit, Text::kLobbyHeadphones, model.settings.has_headphones);
    draw_sound_test(model, kit);
  }
  kit.end_card();
}

}  // namespace

void draw_you_screen(LobbyModel& model, LobbyKit& kit) {
  kit.title(model.texts[Text::kLobbyYouTitle]);
  kit.gap(2.0f);
  draw_name(model, kit);
  draw_source(model, kit);
  draw_figure(model, kit);
  if (model.has_voice) draw_voice(model, kit);
  draw_command(model, kit, LobbyWish::kJoin);
}

void draw_file_chooser(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  FileChooser& chooser = model.chooser;
  kit.title(t[Text::kLobbyChooseFile]);
  ImGui::PushFont(kit.fonts().small);
  const std::string folder = LobbyKit::shortened(chooser.folder(), kit.room_px());
  ImGui::PopFont();
  kit.note(folder);
  if (kit.button(t[Text::kLobbyUp])) chooser.enter_parent();
  kit.beside(t[Text::kLobbyClose]);
  if (kit.button(t[Text::kLobbyClose]) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
    return chooser.close();
  if (!chooser.trouble().empty()) kit.text(chooser.trouble());
  if (chooser.entries().empty()) kit.note(t[Text::kLobbyEmptyFolder]);
  ImGui::BeginChild("entries", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
  for (const FileChooser::Entry& entry : chooser.entries()) {
    if (!kit.row(entry.name.c_str(), entry.name + (entry.is_folder ? "/" : ""), "", false))
      continue;
    const std::string path = chooser.path_of(entry);
    if (entry.is_folder) {
      chooser.enter(path);
      break;
    }
    LobbySettings& settings = model.settings;
    switch (chooser.purpose()) {
      case ChooserPurpose::kMotion:
        settings.motion_file = path;
        settings.source = DancerSource::kFile;
        break;
      case ChooserPurpose::kPartner:
        settings.window.partner = path;
        break;
      case ChooserPurpose::kMusic:
        settings.window.music = path;
        break;
      case ChooserPurpose::kAvatar:
        settings.avatar = path;
        break;
      case ChooserPurpose::kNone:
        break;
    }
    chooser.close();
    break;
  }
  ImGui::EndChild();
}

}  // namespace dance
