#include "lobby/screen/lobby_model.h"

#include <algorithm>

namespace dance {

std::string shell_word(std::string_view word) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_./:@~+,=").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void LobbyModel::take(const LobbySettings& from) {
  settings = from;
  name_typed = settings.name;
  server_typed = settings.server;
  room_typed = settings.room;
  rooms.assign(settings.window.rooms.size(), RoomFact());
  texts = Texts(parse_language(settings.window.language).value_or(language_of_user()));
}

void LobbyModel::show(LobbyScreen to) {
  screen = to;
  if (to == LobbyScreen::kHost) ask(LobbyWish::kListInvited);
  shows_command = false;
}

void LobbyModel::forget(Text banner) {
  std::erase_if(banners, [&](const LobbyBanner& it) { return it.text == banner; });
}

void LobbyModel::tell(LobbyBanner banner) {
  forget(banner.text);
  banners.insert(banners.begin(), std::move(banner));
  if (banners.size() > kMostBanners) banners.pop_back();
}

// The first counts; while going in only the way back.
void LobbyModel::ask(LobbyWish what) {
  if (is_going_in && what != LobbyWish::kCancel && what != LobbyWish::kQuit) return;
  if (wish == LobbyWish::kNone) wish = what;
}

void LobbyModel::set_language(Language language) {
  texts = Texts(language);
  for (const LanguageName& it : kLanguages)
    if (it.language == language) settings.window.language = std::string(it.code);
}

bool LobbyModel::choose_typed_room() {
  const std::string room = name_from(room_typed);
  const auto known = KnownRoom::parse(room + "@" + server_typed);
  if (!known) return false;
  choose_room(*known);
  return true;
}

void LobbyModel::choose_room(const KnownRoom& room) {
  settings.room = room_typed = room.room;
  settings.server = server_typed = room.server;
  remember_room();
}

void LobbyModel::remember_room() {
  if (settings.server.empty()) return;
  auto& known = settings.window.rooms;
  const KnownRoom room{settings.room, settings.server};
  rooms.resize(known.size());
  RoomFact fact;
  if (const auto at = std::find(known.begin(), known.end(), room); at != known.end()) {
    const auto own = rooms.begin() + (at - known.begin());
    fact = std::move(*own);
    rooms.erase(own);
    known.erase(at);
  }
  known.insert(known.begin(), room);
  rooms.insert(rooms.begin(), std::move(fact));
  if (known.size() > WindowChoices::kMostRooms) known.resize(WindowChoices::kMostRooms);
  rooms.resize(known.size());
}

void LobbyModel::forget_room(std::size_t which) {
  auto& known = settings.window.rooms;
  if (which >= known.size()) return;
  rooms.resize(known.size());
  known.erase(known.begin() + static_cast<std::ptrdiff_t>(which));
  rooms.erase(rooms.begin() + static_cast<std::ptrdiff_t>(which));
}

std::string LobbyModel::command(LobbyWish what) const {
  const std::string join = "dance join " + shell_word(settings_path);
  switch (what) {
    case LobbyWish::kJoin:
      return join;
    case LobbyWish::kAlone:
      return join + " --alone --partner " + shell_word(settings.window.partner);
    case LobbyWish::kPractise: {
      std::string line = join + " --alone";
      if (!settings.window.music.empty()) line += " --music " + shell_word(settings.window.music);
      return settings.window.mirror ? line + " --view mirror" : line;
    }
    case LobbyWish::kOpenRoom:
      return "dance server --bind 0.0.0.0 --port " + std::to_string(host.port);
    case LobbyWish::kInvite: {
      const std::string name = name_from(host.guest);
      std::string line =
          "dance server --invite " + (name.empty() ? "NAME" : name) + " --room " + settings.room;
      if (!host.address.empty()) line += " --address " + shell_word(host.address);
      return line;
    }
    case LobbyWish::kOpenInvitation:
      return "dance join 'dance://...'";
    default:
      return "dance lobby";
  }
}

std::optional<LobbyBanner> LobbyModel::trouble_before(LobbyWish what) const {
  using enum DancerSource;
  if (what == LobbyWish::kJoin && !KnownRoom::parse(settings.room + "@" + settings.server))
    return LobbyBanner{
        LobbyBanner::Kind::kTrouble, Text::kLobbyNoRoomYet, {}, "", Text::kCount, LobbyWish::kNone};
  if (settings.source != kCamera) return std::nullopt;
  if (!has_camera)
    return LobbyBanner{LobbyBanner::Kind::kTrouble,
                       Text::kLobbyNoCameraBuilt,
                       {},
                       "",
                       Text::kCount,
                       LobbyWish::kNone};
  if (!knows_cameras) return std::nullopt;
  if (cameras.empty())
    return LobbyBanner{LobbyBanner::Kind::kTrouble, Text::kLobbyNoCamera, {}, "",
                       Text::kLobbyLookAgain,       LobbyWish::kLookAgain};
  for (const CameraFact& camera : cameras)
    if ((settings.camera.empty() || settings.camera == camera.path) && !camera.trouble.empty())
      return LobbyBanner{
          LobbyBanner::Kind::kTrouble, Text::kLobbyCameraTaken, {camera.path}, camera.trouble,
          Text::kLobbyLookAgain,       LobbyWish::kLookAgain};
  return std::nullopt;
}

}  // namespace dance
