#include <imgui.h>

#include "lobby/screen/lobby_screens.h"

namespace dance {
namespace {

constexpr std::size_t kMostAddressBytes = 262;

void draw_state(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  const HostFacts& host = model.host;
  using State = HostFacts::State;
  kit.begin_card(nullptr);
  kit.text(t[host.state == State::kOpen      ? Text::kLobbyRoomOpen
             : host.state == State::kOpening ? Text::kLobbyRoomOpening
                                             : Text::kLobbyRoomClosed]);
  const bool is_closed = host.state == State::kClosed;
  if (is_closed ? kit.button(t[Text::kLobbyOpenRoom], ButtonLook::kAccent, 200.0f)
                : kit.button(t[Text::kLobbyCloseRoom], ButtonLook::kPlain, 200.0f))
    model.ask(is_closed ? LobbyWish::kOpenRoom : LobbyWish::kCloseRoom);
  if (host.state == State::kOpen) {
    kit.beside(t[Text::kLobbyJoin], 140.0f);
    if (kit.button(t[Text::kLobbyJoin], ButtonLook::kAccent, 140.0f)) {
      model.choose_room({model.settings.room, "127.0.0.1:" + std::to_string(host.port)});
      model.ask(LobbyWish::kJoin);
    }
  }
  kit.beside(t[Text::kLobbyShowCommand]);
  draw_command(model, kit, LobbyWish::kOpenRoom);
  if (!host.addresses.empty()) {
    kit.text(t[Text::kLobbyReachedHere]);
    std::string all;
    for (const std::string& address : host.addresses) all += (all.empty() ? "" : "\n") + address;
    kit.box(all);
  }
  kit.note(t.say(Text::kLobbyReachedOutside, {std::to_string(host.port)}));
  if (!is_closed) kit.note(t[host.was_reached ? Text::kLobbyWasReached : Text::kLobbyNotReached]);
  kit.end_card();
}

void draw_guests(LobbyModel& model, LobbyKit& kit) {
  if (model.host.state != HostFacts::State::kOpen) return;
  kit.begin_card(model.texts[Text::kLobbyWhoIsHere]);
  if (model.host.guests.empty()) kit.note(model.texts[Text::kLobbyNobodyHere]);
  for (const std::string& guest : model.host.guests) kit.text(guest);
  kit.end_card();
}

void draw_invitations(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  HostFacts& host = model.host;
  kit.begin_card(t[Text::kLobbyInvitations]);
  kit.label(t[Text::kLobbyGuestName]);
  kit.field("##guest", host.guest, 260.0f, kMaxGuestIdLength);
  kit.text(t[Text::kLobbyHostAddress]);
  kit.field("##address", host.address, 420.0f, kMostAddressBytes);
  if (kit.button(t[Text::kLobbyInvite], ButtonLook::kAccent, 200.0f)) model.ask(LobbyWish::kInvite);
  kit.beside(t[Text::kLobbyShowCommand]);
  draw_command(model, kit, LobbyWish::kInvite);
  if (!host.invitation.empty()) {
    kit.note(t.say(Text::kLobbyInvitationNote, {host.invited_guest}));
    kit.box(host.invitation);
    if (host.code.size > 0) kit.code(host.code.size, host.code.dark);
    ImGui::PushID("invitation");
    if (kit.button(t[Text::kLobbyCopy])) ImGui::SetClipboardText(host.invitation.c_str());
    ImGui::PopID();
  }
  kit.gap(4.0f);
  if (host.invited.empty()) kit.note(t[Text::kLobbyNoInvited]);
  for (const std::string& name : host.invited) {
    ImGui::PushID(name.c_str());
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name.c_str());
    ImGui::SameLine(kit.px(300.0f));
    if (kit.button(t[Text::kLobbyWithdraw])) {
      host.withdrawn = name;
      model.ask(LobbyWish::kWithdraw);
    }
    ImGui::PopID();
  }
  kit.end_card();
}

}  // namespace

void draw_host_screen(LobbyModel& model, LobbyKit& kit) {
  kit.title(model.texts[Text::kLobbyHostTitle]);
  kit.gap(2.0f);
  draw_state(model, kit);
  draw_guests(model, kit);
  draw_invitations(model, kit);
}

}  // namespace dance
