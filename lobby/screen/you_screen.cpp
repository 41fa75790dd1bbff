#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "lobby/screen/lobby_screens.h"

namespace dance {
namespace {

std::string file_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

void draw_name(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  kit.begin_card(nullptr);
  kit.label(t[Text::kLobbyYourName]);
  if (kit.field("##name", model.name_typed, 260.0f, kMaxShownNameBytes)) model.take_typed_name();
  if (model.name_typed != model.settings.name)
    kit.note(t.say(Text::kLobbyYourId, {model.settings.name}));
  kit.end_card();
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
  if (model.has_camera) {
    const bool is_video = is_video_file(model.settings.camera);
    const std::string words =
        LobbyKit::shortened(is_video ? file_name(model.settings.camera) : t[Text::kLobbyVideoFile],
                            kit.px(300.0f)) +
        "##video";
    if (kit.button(t[Text::kLobbyLookAgain])) model.ask(LobbyWish::kLookAgain);
    kit.beside(words.c_str());
    if (kit.choice(words.c_str(), is_video))
      model.chooser.open(ChooserPurpose::kVideo, is_video ? model.settings.camera : "");
  }
}

void draw_headset(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  const bool is_missing = model.has_headset && !model.headset_error.empty();
  kit.text(t[!model.has_headset ? Text::kLobbyNoHeadsetBuilt
             : is_missing       ? Text::kLobbyNoHeadset
                                : Text::kLobbyHeadsetHow]);
  if (!is_missing) return;
  kit.note(model.headset_error);
  if (kit.button(t[Text::kLobbyLookAgain])) model.ask(LobbyWish::kLookAgain);
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
      Place{kFile, Text::kLobbyFromFile},     Place{kSynthetic, Text::kLobbyFromNobody},
      Place{kWatch, Text::kLobbyOnlyWatch},   Place{kElsewhere, Text::kLobbyFromElsewhere}};
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
  if (source == kHeadset) draw_headset(model, kit);
  if (source == kFile) draw_motion_file(model, kit);
  if (source == kWatch) kit.note(t[Text::kLobbyOnlyWatchNote]);
  if (source == kSynthetic) {
    std::string& role = model.settings.role;
    if (kit.choice(t[Text::kLobbyAnyRole], role == "any")) role = "any";
    kit.beside(t[Text::kLobbyLeads]);
    if (kit.choice(t[Text::kLobbyLeads], role == "lead")) role = "lead";
    kit.beside(t[Text::kLobbyFollows]);
    if (kit.choice(t[Text::kLobbyFollows], role == "follow")) role = "follow";
  }
  kit.end_card();
}

void draw_yes_or_no(const Texts& t, LobbyKit& kit, Text question, bool& answer) {
  ImGui::PushID(static_cast<int>(question));
  ImGui::AlignTextToFramePadding();
  kit.text(t[question]);
  ImGui::SameLine(kit.px(300.0f));
  if (kit.choice(t[Text::kLobbyYes], answer)) answer = true;
  ImGui::SameLine();
  if (kit.choice(t[Text::kLobbyNo], !answer)) answer = false;
  ImGui::PopID();
}

void draw_devices(LobbyKit& kit, const Texts& t, Text heading,
                  const std::vector<LobbySoundDevice>& devices, std::string& chosen) {
  kit.note(t[heading]);
  ImGui::PushID(static_cast<int>(heading));
  if (kit.row("usual", t[Text::kLobbyUsualDevice], "", chosen.empty())) chosen.clear();
  for (const LobbySoundDevice& device : devices)
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
  draw_figure_card(model, kit);
  if (model.has_voice) draw_voice(model, kit);
  draw_commands(model, kit, {{Text::kLobbyJoin, LobbyWish::kJoin}});
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
      case ChooserPurpose::kTeacher:
        settings.window.teacher = path;
        break;
      case ChooserPurpose::kMusic:
        settings.window.music = path;
        break;
      case ChooserPurpose::kAvatar:
        settings.avatar = path;
        break;
      case ChooserPurpose::kVideo:
        settings.camera = path;
        settings.source = DancerSource::kCamera;
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
