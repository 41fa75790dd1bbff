#include "lobby/run/room_host.h"

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/base/printable.h"
#include "core/net/machine_addresses.h"
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

std::vector<std::string> names_of_keys(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream lines(list);
  std::string line;
  std::getline(lines, line);  // the heading
  while (std::getline(lines, line) && names.size() < kMostShown) {
    const std::string name = line.substr(0, line.find(' '));
    if (GuestId::parse(name)) names.push_back(name);
  }
  return names;
}

void RoomHost::open(LobbyModel& model) {
  auto started = ChildWords::start(
      "dance-server", {"--bind", "0.0.0.0", "--port", std::to_string(model.host.port)});
  if (!started)
    return model.tell({LobbyBanner::Kind::kTrouble,
                       Text::kLobbyRoomFailed,
                       {},
                       started.error().what,
                       Text::kCount,
                       LobbyWish::kNone});
  server_ = std::move(*started);
  model.host.state = HostFacts::State::kOpening;
}

void RoomHost::close(LobbyModel& model) {
  if (server_) server_->process().stop(kServerEnds);
  server_.reset();
  model.host.state = HostFacts::State::kClosed;
  model.host.guests.clear();
}

void RoomHost::run(LobbyModel& model, const std::string& program,
                   std::vector<std::string> arguments, Done done) {
  auto started = ChildWords::start(program, std::move(arguments), true);
  if (!started)
    return model.tell({LobbyBanner::Kind::kTrouble,
                       Text::kLobbyInviteFailed,
                       {},
                       started.error().what,
                       Text::kCount,
                       LobbyWish::kNone});
  command_ = std::move(*started);
  done_ = std::move(done);
}

void RoomHost::list(LobbyModel& model) {
  run(model, "dance-server", {"--list-keys"}, [](LobbyModel& to, ChildWords& said) {
    if (said.process().ended_well()) to.host.invited = names_of_keys(said.output());
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
    if (said.process().ended_well()) {
      to.host.invitation = printable(said.output().substr(0, said.output().find('\n')));
      if (auto code = make_qr_code(to.host.invitation))
        to.host.code = {code->size, std::move(code->dark)};
    } else {
      to.tell({LobbyBanner::Kind::kTrouble,
               Text::kLobbyInviteFailed,
               {},
               said.lines().empty() ? "" : said.lines().back(),
               Text::kCount,
               LobbyWish::kNone});
    }
    list(to);
  });
}

void RoomHost::withdraw(LobbyModel& model) {
  run(model, "dance-server", {"--remove-key", std::exchange(model.host.withdrawn, "")},
      [this](LobbyModel& to, ChildWords&) { list(to); });
}

bool RoomHost::look_at_server(LobbyModel& model) {
  if (!server_ || !server_->read()) return false;
  for (const std::string& line : server_->take_lines())
    if (line.starts_with("hears on ")) model.host.state = HostFacts::State::kOpen;
  if (!server_->process().has_ended()) return true;
  const std::string last = server_->lines().empty() ? "" : server_->lines().back();
  const bool is_taken = last.find("in use") != std::string::npos;
  model.tell({LobbyBanner::Kind::kTrouble,
              is_taken ? Text::kLobbyPortTaken : Text::kLobbyRoomFailed,
              {std::to_string(model.host.port)},
              last,
              Text::kCount,
              LobbyWish::kNone});
  close(model);
  return true;
}

bool RoomHost::look(LobbyModel& model, MonoTime now, bool is_shown) {
  bool is_new = look_at_server(model);
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
