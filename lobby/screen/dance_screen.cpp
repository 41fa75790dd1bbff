#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "lobby/screen/lobby_screens.h"
#include "producers/music/band/band_song.h"
#include "viewer/scene/place.h"

namespace dance {
namespace {

constexpr double kNear_ms = 80.0;  // a round trip in which a couple hardly feels the line
constexpr std::size_t kMostServerBytes = 262;
constexpr float kTile_u = 300.0f;      // least width of the big buttons
constexpr std::size_t kMostNames = 8;  // the others are counted
constexpr std::size_t kMostInvitationBytes = 1024;

std::string last_part(const std::string& path) { return path.substr(path.rfind('/') + 1); }

void draw_partner(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& partner = model.settings.window.partner;
  kit.label(t[Text::kLobbyPartner]);
  if (kit.choice(t[Text::kLobbyFollows], partner == "follow")) partner = "follow";
  kit.beside(t[Text::kLobbyLeads]);
  if (kit.choice(t[Text::kLobbyLeads], partner == "lead")) partner = "lead";
  const bool is_file = partner != "follow" && partner != "lead";
  const std::string words =
      LobbyKit::shortened(is_file ? last_part(partner) : t[Text::kLobbyRecordedPartner],
                          kit.px(240.0f)) +
      "##recorded";
  kit.beside(words.c_str());
  if (kit.choice(words.c_str(), is_file))
    model.chooser.open(ChooserPurpose::kPartner, is_file ? partner : "");
}

void draw_band(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& band = model.settings.window.band;
  kit.label(t[Text::kBandLabel]);
  for (int i = 0; i < kBandStyles; ++i) {
    const std::string name(name_of(static_cast<BandStyle>(i)));
    static_assert(static_cast<int>(Text::kBandWaltz) - static_cast<int>(Text::kBandSalsa) ==
                  kBandStyles - 1);
    const char* words = t[static_cast<Text>(static_cast<int>(Text::kBandSalsa) + i)];
    if (i > 0) kit.beside(words);
    if (kit.choice(words, band == name)) band = name;
  }
  kit.beside(t[Text::kBandNone]);
  if (kit.choice(t[Text::kBandNone], band == kNoBand)) band = kNoBand;
}

void draw_place(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& place = model.settings.window.place;
  kit.label(t[Text::kPlaceLabel]);
  for (const Text text :
       {Text::kPlaceStudio, Text::kPlaceBar, Text::kPlaceTerrace, Text::kPlacePlain}) {
    const auto which = static_cast<std::size_t>(text) - static_cast<std::size_t>(Text::kPlacePlain);
    const PlaceName& it = kPlaceNames[which];
    if (text != Text::kPlaceStudio) kit.beside(t[text]);
    if (kit.choice(t[text], place == it.option)) place = it.option;
  }
}

void draw_teacher(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  std::string& teacher = model.settings.window.teacher;
  kit.label(t[Text::kLobbyTeacher]);
  ImGui::PushID("teacher");
  if (kit.choice(t[Text::kLobbyNo], teacher.empty())) teacher.clear();
  const std::string words = LobbyKit::shortened(
      teacher.empty() ? t[Text::kLobbyChooseFile] : last_part(teacher), kit.px(300.0f));
  kit.beside(words.c_str());
  if (kit.choice(words.c_str(), !teacher.empty()))
    model.chooser.open(ChooserPurpose::kTeacher, teacher);
  ImGui::PopID();
}

void draw_practice(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  WindowChoices& window = model.settings.window;
  if (model.has_music) {
    kit.label(t[Text::kLobbyMusic]);
    const bool has_music = !window.music.empty();
    const Text without = window.band == kNoBand ? Text::kLobbyNoMusic : Text::kBandLabel;
    if (kit.choice(t[without], !has_music)) window.music.clear();
    const std::string words =
        LobbyKit::shortened(has_music ? last_part(window.music) : t[Text::kLobbyChooseFile],
                            kit.px(300.0f)) +
        "##music";
    kit.beside(words.c_str());
    if (kit.choice(words.c_str(), has_music))
      model.chooser.open(ChooserPurpose::kMusic, window.music);
    if (has_music) kit.note(t[Text::kLobbyMusicSeeks]);
  }
  kit.label(t[Text::kLobbyMirror]);
  ImGui::PushID("mirror");
  if (kit.choice(t[Text::kLobbyYes], window.mirror)) window.mirror = true;
  kit.beside(t[Text::kLobbyNo]);
  if (kit.choice(t[Text::kLobbyNo], !window.mirror)) window.mirror = false;
  ImGui::PopID();
  draw_teacher(model, kit);
}

// The two big buttons.
void draw_now(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  const float room = kit.room_px();
  const float least = kit.px(kTile_u);
  const float width = room > 1.6f * least ? std::max(least, 0.46f * room) : room;
  if (kit.tile(t[Text::kLobbyDanceNow], t[Text::kLobbyAloneNote], width, ButtonLook::kAccent))
    model.ask(LobbyWish::kAlone);
  ImGui::SetItemDefaultFocus();
  if (kit.tile(t[Text::kLobbyPractise], t[Text::kLobbyPractiseNote], width, ButtonLook::kPlain))
    model.ask(LobbyWish::kPractise);
}

// The dancing couple is as high as title and buttons together, and partly behind the buttons.
void draw_couple(const LobbyModel& model, LobbyKit& kit) {
  constexpr float kWidth_u = FigureFacts::kCoupleWidth_u, kHeight_u = FigureFacts::kCoupleHeight_u;
  const float width = std::min(kit.px(kWidth_u), kit.room_px());
  kit.backdrop(model.figures.couple_texture, kWidth_u / kHeight_u, width, kit.px(kHeight_u));
}

void draw_choices(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  kit.begin_card(nullptr);
  kit.note(t[Text::kLobbyDanceNow]);
  draw_partner(model, kit);
  if (model.has_music) draw_band(model, kit);
  kit.note(t[Text::kLobbyPractise]);
  draw_practice(model, kit);
  kit.gap(0.5f);
  draw_place(model, kit);
  kit.end_card();
}

void draw_invitation(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  kit.begin_card(t[Text::kLobbyInvitation]);
  kit.note(t[Text::kLobbyInvitationPaste]);
  kit.field("##invitation", model.invitation_typed, 600.0f, kMostInvitationBytes);
  kit.beside(t[Text::kLobbyPaste]);
  if (kit.button(t[Text::kLobbyPaste])) {
    const char* copied = ImGui::GetClipboardText();
    const std::string text = copied != nullptr ? copied : "";
    model.invitation_typed = text.substr(0, kMostInvitationBytes);
  }
  if (kit.button(t[Text::kLobbyOpenInvitation], ButtonLook::kAccent, 140.0f))
    model.ask(LobbyWish::kOpenInvitation);
  kit.note(t[Text::kLobbyInvitationFirst]);
  kit.end_card();
}

std::string state_words(const LobbyModel& model, std::size_t which) {
  if (which >= model.rooms.size()) return "";
  const RoomFact& fact = model.rooms[which];
  const KnownRoom& room = model.settings.window.rooms[which];
  if (fact.state != RoomFact::State::kAnswers && model.is_own_room(room) &&
      model.host.state == HostFacts::State::kClosed)
    return model.texts[Text::kLobbyOwnRoomClosed];
  if (fact.state == RoomFact::State::kAsking) return model.texts[Text::kLobbyAsking];
  if (fact.state == RoomFact::State::kSilent) return model.texts[Text::kLobbySilent];
  const double ms = fact.round_trip.as_ms();
  char number[24];
  std::snprintf(number, sizeof number, ms < 10.0 ? "%.1f" : "%.0f", ms);
  return model.texts.say(ms < kNear_ms ? Text::kLobbyNear : Text::kLobbyFar, {number});
}

std::string who_words(const LobbyModel& model, std::size_t which) {
  if (which >= model.rooms.size()) return "";
  const RoomFact& fact = model.rooms[which];
  if (fact.who == RoomFact::Who::kNoKey) return model.texts[Text::kLobbyThereNoKey];
  if (fact.who == RoomFact::Who::kRefused) return model.texts[Text::kLobbyThereRefused];
  if (fact.who == RoomFact::Who::kUnknown) return "";
  if (fact.guest_count == 0) return model.texts[Text::kLobbyThereNobody];
  const std::size_t shown = std::min(fact.guests.size(), kMostNames);
  std::string names;
  for (std::size_t i = 0; i < shown; ++i) names += (names.empty() ? "" : ", ") + fact.guests[i];
  if (shown == fact.guest_count) return model.texts.say(Text::kLobbyThere, {names});
  return model.texts.say(Text::kLobbyThereMore, {names, std::to_string(fact.guest_count - shown)});
}

void draw_rooms(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  kit.begin_card(t[Text::kLobbyRooms]);
  const auto known = model.settings.window.rooms;  // a click changes the list
  if (known.empty()) kit.note(t[Text::kLobbyNoRooms]);
  const float join_u =
      (ImGui::CalcTextSize(t[Text::kLobbyForget]).x + kit.px(52.0f)) / kit.px(1.0f);
  for (std::size_t i = 0; i < known.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const bool is_own = model.is_own_room(known[i]);
    const std::string what = is_own ? t.say(Text::kLobbyOwnRoom, {known[i].room})
                                    : t.say(Text::kLobbyRoomAt, {known[i].room, known[i].server});
    if (kit.row("room", what, state_words(model, i), false, join_u)) model.join_known_room(i);
    ImGui::SameLine();
    if (kit.button(t[Text::kLobbyForget], ButtonLook::kQuiet)) model.forget_room(i);
    if (is_own && model.host.state == HostFacts::State::kClosed) {
      if (kit.button(t[Text::kLobbyOpenIt])) model.open_own_room(known[i]);
    } else if (const std::string who = who_words(model, i); !who.empty())
      kit.note(who);
    ImGui::PopID();
  }
  if (!known.empty() && kit.button(t[Text::kLobbyAskAgain])) model.ask(LobbyWish::kAskRooms);
  kit.end_card();
}

void draw_other_room(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  kit.begin_card(t[Text::kLobbyOtherRoom]);
  kit.label(t[Text::kLobbyRoom]);
  kit.field("##room", model.room_typed, 260.0f, kMaxGuestIdLength);
  kit.label(t[Text::kLobbyServer]);
  kit.field("##server", model.server_typed, 420.0f, kMostServerBytes);
  if (kit.button(t[Text::kLobbyJoin], ButtonLook::kAccent, 140.0f)) {
    if (model.choose_typed_room())
      model.ask(LobbyWish::kJoin);
    else
      model.tell(error_banner(Text::kLobbyNoRoomYet));
  }
  kit.end_card();
}

}  // namespace

void draw_dance_screen(LobbyModel& model, LobbyKit& kit) {
  draw_couple(model, kit);
  kit.title(model.texts[Text::kLobbyDanceTitle]);
  kit.gap(2.0f);
  draw_now(model, kit);
  kit.gap(2.0f);
  // A friend who was invited sees the field without scrolling, also in a small window.
  draw_invitation(model, kit);
  draw_rooms(model, kit);
  draw_choices(model, kit);
  draw_other_room(model, kit);
  draw_commands(model, kit,
                {{Text::kLobbyDanceNow, LobbyWish::kAlone},
                 {Text::kLobbyPractise, LobbyWish::kPractise},
                 {Text::kLobbyOpenInvitation, LobbyWish::kOpenInvitation},
                 {Text::kLobbyJoin, LobbyWish::kJoin}});
}

}  // namespace dance
