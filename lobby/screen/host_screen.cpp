#include <imgui.h>

#include "lobby/screen/lobby_screens.h"

namespace dance {
namespace {

constexpr std::size_t kMostAddressBytes = 262;

void draw_router(LobbyModel& model, LobbyKit& kit) {
  using Router = HostFacts::Router;
  const Texts& t = model.texts;
  const HostFacts& host = model.host;
  switch (host.router) {
    case Router::kNotAsked:
      if (kit.button(t[Text::kRouterAsk])) model.ask(LobbyWish::kAskRouter);
      return;
    case Router::kAsking:
      return kit.text(t[Text::kRouterAsking]);
    case Router::kOpen:
      return kit.text(t.say(Text::kRouterOpen, {host.router_address}));
    case Router::kBehindAnother:
      return kit.text(t.say(Text::kRouterBehind, {host.router_address}));
    case Router::kRefused:
      return kit.text(t[Text::kRouterRefused]);
    case Router::kSilent:
      return kit.text(t[Text::kRouterSilent]);
  }
}

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
  if (!host.addresses.empty()) {
    kit.text(t[Text::kLobbyReachedHere]);
    std::string all;
    for (const std::string& address : host.addresses) all += (all.empty() ? "" : "\n") + address;
    kit.box(all);
  }
  kit.note(t.say(Text::kLobbyReachedOutside, {std::to_string(host.port)}));
  if (host.state == State::kOpen) draw_router(model, kit);
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

std::string state_words(const Texts& t, const InvitedGuest& guest) {
  switch (guest.state) {
    case InvitedGuest::State::kInvited:
      return t.say(Text::kLobbyInvitedUntil, {guest.until});
    case InvitedGuest::State::kExpired:
      return t[Text::kLobbyInvitationExpired];
    case InvitedGuest::State::kUsed:
      break;
  }
  return guest.until.empty() ? std::string(t[Text::kLobbyInvitationUsed])
                             : t.say(Text::kLobbyInvitationUsedUntil, {guest.until});
}

void draw_invited(LobbyModel& model, LobbyKit& kit, const InvitedGuest& guest) {
  const Texts& t = model.texts;
  ImGui::PushID(guest.name.c_str());
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(guest.name.c_str());
  ImGui::SameLine(kit.px(300.0f));
  if (kit.button(t[Text::kLobbyWithdraw])) {
    model.host.withdrawn = guest.name;
    model.ask(LobbyWish::kWithdraw);
  }
  kit.note(state_words(t, guest));
  ImGui::PopID();
}

// The last invitation, and the buttons that copy or save it.
void draw_made(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  const HostFacts& host = model.host;
  kit.note(t.say(Text::kLobbyInvitationNote, {host.invited_guest}));
  kit.box(host.invitation);
  kit.text(host.is_for_home_only ? std::string(t[Text::kInviteHome])
                                 : t.say(Text::kInviteEverywhere, {std::to_string(host.port)}));
  if (host.code.size > 0) kit.code(host.code.size, host.code.dark);
  ImGui::PushID("invitation");
  if (kit.button(t[Text::kLobbyCopy])) ImGui::SetClipboardText(host.invitation.c_str());
  kit.beside(t[Text::kInviteCopyMessage]);
  if (kit.button(t[Text::kInviteCopyMessage])) model.ask(LobbyWish::kCopyMessage);
  kit.beside(t[Text::kInviteSavePage]);
  if (kit.button(t[Text::kInviteSavePage])) model.ask(LobbyWish::kSavePage);
  if (!host.page.empty()) {
    kit.text(t.say(Text::kInvitePageSaved, {host.page, host.invited_guest}));
    if (model.shelf.has_opener && kit.button(t[Text::kLobbyOpenFolder]))
      model.ask(LobbyWish::kOpenPageFolder);
  }
  ImGui::PopID();
}

void draw_invitations(LobbyModel& model, LobbyKit& kit) {
  const Texts& t = model.texts;
  HostFacts& host = model.host;
  kit.begin_card(t[Text::kLobbyInvitations]);
  kit.label(t[Text::kLobbyGuestName]);
  kit.field("##guest", host.guest, 260.0f, kMaxGuestIdLength);
  kit.text(t[Text::kLobbyHostAddress]);
  kit.field("##address", host.address, 420.0f, kMostAddressBytes);
  const std::string name = name_from(host.guest);
  const bool is_own_name = name == model.settings.name;
  if (is_own_name) kit.text(t.say(Text::kLobbyInviteSelf, {name}));
  ImGui::BeginDisabled(name.empty() || is_own_name);
  if (kit.button(t[Text::kLobbyInvite], ButtonLook::kAccent, 200.0f)) model.ask(LobbyWish::kInvite);
  ImGui::EndDisabled();
  if (!host.invitation.empty()) draw_made(model, kit);
  kit.gap(4.0f);
  if (host.invited.empty()) kit.note(t[Text::kLobbyNoInvited]);
  for (const InvitedGuest& guest : host.invited) draw_invited(model, kit, guest);
  kit.end_card();
}

}  // namespace

void draw_host_screen(LobbyModel& model, LobbyKit& kit) {
  kit.title(model.texts[Text::kLobbyHostTitle]);
  kit.gap(2.0f);
  draw_state(model, kit);
  draw_invitations(model, kit);
  draw_guests(model, kit);
  draw_commands(
      model, kit,
      {{Text::kLobbyOpenRoom, LobbyWish::kOpenRoom}, {Text::kLobbyInvite, LobbyWish::kInvite}});
}

}  // namespace dance
