#include "lobby/run/room_host.h"

#include <imgui.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/base/printable.h"
#include "core/net/machine_addresses.h"
#include "core/program/whole_file.h"
#include "lobby/invite/invitation_page.h"
#include "lobby/run/machine_facts.h"
#include "tunnel/invitation/qr_code.h"

namespace dance {
namespace {

constexpr Duration kAskGuestsAfter = Duration::s(2);
constexpr std::size_t kMostShown = 64;
constexpr Duration kServerEnds = Duration::s(2);

std::string short_text(const nlohmann::json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return "";
  return printable(object[key].get<std::string>().substr(0, 80));
}

// "203.0.113.5:4711 alice" → "203.0.113.5"; of "[::1]:4711 …" what is in the brackets.
std::string host_of_peer(const std::string& peer) {
  if (peer.starts_with('[')) return peer.substr(1, peer.find(']') - 1);
  return peer.substr(0, peer.find(':'));
}

const nlohmann::json& list_in(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kNothing = nlohmann::json::array();
  if (!object.is_object() || !object.contains(key) || !object[key].is_array()) return kNothing;
  return object[key];
}

}  // namespace

ServerGuests guests_of_status(const std::string& text) {
  ServerGuests found;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  for (const auto& room : list_in(json, "rooms"))
    for (const auto& link : list_in(room, "links")) {
      const std::string host = host_of_peer(short_text(link, "peer"));
      if (!host.empty() && !is_private_address(host)) found.was_reached_from_elsewhere = true;
      for (const auto& guest : list_in(link, "guests"))
        if (found.guests.size() < kMostShown)
          found.guests.push_back(short_text(guest, "name") + " (" + short_text(room, "name") + ")");
    }
  return found;
}

// Each line has name, kind, room and state: "invited, until 2026-12-01 08:00 UTC".
std::vector<InvitedGuest> invited_guests(const std::string& list) {
  std::vector<InvitedGuest> guests;
  std::istringstream lines(list);
  std::string line;
  std::getline(lines, line);  // the heading
  while (std::getline(lines, line) && guests.size() < kMostShown) {
    InvitedGuest guest;
    guest.name = line.substr(0, line.find(' '));
    if (!GuestId::parse(guest.name)) continue;
    const auto has = [&](std::string_view words) { return line.find(words) != std::string::npos; };
    if (has(" invited, until ")) guest.state = InvitedGuest::State::kInvited;
    if (has(" expired ")) guest.state = InvitedGuest::State::kExpired;
    constexpr std::string_view kUntil = "until ";
    if (const std::size_t at = line.rfind(kUntil); at != std::string::npos)
      guest.until = printable(line.substr(at + kUntil.size(), 24));
    guests.push_back(std::move(guest));
  }
  return guests;
}

void RoomHost::open(LobbyModel& model) {
  auto started = ChildWords::start("dance-server",
                                   {"--bind", "::", "--port", std::to_string(model.host.port)});
  if (!started) return model.tell(error_banner(Text::kLobbyRoomFailed, {}, started.error().what));
  server_ = std::move(*started);
  model.host.state = HostFacts::State::kOpening;
}

void RoomHost::close(LobbyModel& model) {
  if (server_) server_->process().stop(kServerEnds);
  server_.reset();
  if (router_) router_->close();
  router_.reset();
  model.host.router = HostFacts::Router::kNotAsked;
  // Without the router's port its address would be wrong in the next room's invitations.
  if (model.host.address == model.host.router_address) model.host.address.clear();
  model.host.router_address.clear();
  model.host.state = HostFacts::State::kClosed;
  model.host.guests.clear();
}

void RoomHost::run(LobbyModel& model, const std::string& program,
                   std::vector<std::string> arguments, Done done) {
  auto started = ChildWords::start(program, std::move(arguments), true);
  if (!started) return model.tell(error_banner(Text::kLobbyInviteFailed, {}, started.error().what));
  command_ = std::move(*started);
  done_ = std::move(done);
}

void RoomHost::list(LobbyModel& model) {
  run(model, "dance-server", {"--list-keys"}, [](LobbyModel& to, ChildWords& said) {
    if (said.process().ended_well()) to.host.invited = invited_guests(said.output());
  });
}

void RoomHost::invite(LobbyModel& model) {
  const std::string name = name_from(model.host.guest);
  model.host.guest = name;
  std::vector<std::string> words{"--invite",          name,     "--room",
                                 model.settings.room, "--port", std::to_string(model.host.port)};
  if (!model.host.address.empty()) words.push_back("--address=" + model.host.address);
  run(model, "dance-server", words, [this, name](LobbyModel& to, ChildWords& said) {
    to.host.invitation.clear();
    to.host.code = InvitationCode();
    to.host.invited_guest = name;
    to.host.page.clear();
    if (said.process().ended_well()) {
      to.forget(Text::kLobbyInviteFailed);
      to.host.invitation = printable(said.output().substr(0, said.output().find('\n')));
      if (const auto made = parse_invitation(to.host.invitation))
        to.host.is_for_home_only = reach_of(made->host) != InvitationReach::kEverywhere;
      if (auto code = make_qr_code(to.host.invitation))
        to.host.code = {code->size, std::move(code->dark)};
    } else {
      to.tell(error_banner(Text::kLobbyInviteFailed, {}, said.last_line()));
    }
    list(to);
  });
}

void RoomHost::ask_router(LobbyModel& model, MonoTime now) {
  const Address router = default_router();
  model.host.router = HostFacts::Router::kSilent;
  if (!router.is_set() || !server_) return;
  auto started =
      RouterPort::start(router.with_port(RouterPort::kProtocolPort), model.host.port, now);
  if (!started) return;
  router_.emplace(std::move(*started));
  model.host.router = HostFacts::Router::kAsking;
}

bool RoomHost::look_at_router(LobbyModel& model, MonoTime now) {
  if (!router_ || !router_->work(now)) return false;
  using Router = HostFacts::Router;
  HostFacts& host = model.host;
  switch (router_->state()) {
    case RouterPort::State::kAsking:
      host.router = Router::kAsking;
      break;
    case RouterPort::State::kOpen:
      host.router = router_->is_behind_another() ? Router::kBehindAnother : Router::kOpen;
      host.router_address = router_->address();
      // An address that was typed stays.
      if (host.router == Router::kOpen && host.address.empty()) host.address = host.router_address;
      break;
    case RouterPort::State::kRefused:
      host.router = Router::kRefused;
      break;
    case RouterPort::State::kSilent:
      host.router = Router::kSilent;
      break;
  }
  return true;
}

void RoomHost::copy_message(LobbyModel& model) {
  const auto text = invitation_message(model.texts, model.shown_name(), model.host.invitation);
  if (text) ImGui::SetClipboardText(text->c_str());
}

// The page contains the key, so only this user may read it.
void RoomHost::save_page(LobbyModel& model) {
  namespace fs = std::filesystem;
  const std::vector<std::string> folders = recording_folders();
  const auto page = invitation_page(model.texts, model.shown_name(), model.host.invitation);
  if (folders.empty() || !page) return model.tell(error_banner(Text::kInvitePageNotSaved));
  std::error_code error;
  fs::create_directories(folders.front(), error);
  const std::string path = folders.front() + "/invitation-" + model.host.invited_guest + ".html";
  if (const auto written = write_whole_file(path, *page); !written)
    return model.tell(error_banner(Text::kInvitePageNotSaved, {}, written.error().what));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write, error);
  model.forget(Text::kInvitePageNotSaved);
  model.host.page = with_tilde(path);
}

void RoomHost::open_page_folder(LobbyModel& model) {
  opener_.reset();
  const std::vector<std::string> folders = recording_folders();
  if (folders.empty()) return;
  auto started = open_folder(folders.front());
  if (started)
    opener_ = std::move(*started);
  else
    model.tell(error_banner(Text::kLobbyNotShown, {}, started.error().what));
}

void RoomHost::withdraw(LobbyModel& model) {
  run(model, "dance-server", {"--remove-key=" + std::exchange(model.host.withdrawn, "")},
      [this](LobbyModel& to, ChildWords&) { list(to); });
}

bool RoomHost::look_at_server(LobbyModel& model) {
  if (!server_ || !server_->read()) return false;
  for (const std::string& line : server_->take_lines())
    if (line.starts_with("hears on ")) model.host.state = HostFacts::State::kOpen;
  if (!server_->process().has_ended()) return true;
  const std::string last = server_->last_line();
  const bool is_taken = last.find("in use") != std::string::npos;
  model.tell(error_banner(is_taken ? Text::kLobbyPortTaken : Text::kLobbyRoomFailed,
                          {std::to_string(model.host.port)}, last));
  close(model);
  return true;
}

bool RoomHost::look(LobbyModel& model, MonoTime now, bool is_shown) {
  bool is_new = look_at_server(model);
  is_new = look_at_router(model, now) || is_new;
  if (command_) {
    command_->read();
    if (command_->process().has_ended()) {
      command_->read();
      ChildWords said = std::move(*command_);
      command_.reset();
      std::exchange(done_, nullptr)(model, said);
      is_new = true;
    }
  }
  const bool is_due = !asked_.is_set() || now - asked_ > kAskGuestsAfter;
  if (command_ || !is_shown || !is_due || model.host.state != HostFacts::State::kOpen)
    return is_new;
  asked_ = now;
  run(model, "dance-status", {"--once", "--json", "--port", std::to_string(model.host.port)},
      [](LobbyModel& to, ChildWords& status) {
        if (!status.process().ended_well()) return;
        ServerGuests found = guests_of_status(status.output());
        to.host.guests = std::move(found.guests);
        to.host.was_reached = to.host.was_reached || found.was_reached_from_elsewhere;
      });
  return is_new;
}

}  // namespace dance
