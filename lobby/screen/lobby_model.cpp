#include "lobby/screen/lobby_model.h"

#include <algorithm>
#include <utility>

namespace dance {

LobbyBanner error_banner(Text text, std::vector<std::string> values, std::string detail) {
  LobbyBanner banner;
  banner.text = text;
  banner.values = std::move(values);
  banner.detail = std::move(detail);
  return banner;
}

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

const RecordedDance* ShelfFacts::find_chosen() const {
  const auto at = std::find_if(dances.begin(), dances.end(),
                               [&](const RecordedDance& it) { return it.path == chosen; });
  return at == dances.end() ? nullptr : &*at;
}

std::string_view without_usual_port(std::string_view server) {
  static const std::string usual = ":" + std::to_string(HostFacts::kUsualPort);
  if (server.ends_with(usual)) server.remove_suffix(usual.size());
  return server;
}

namespace {

LobbyBanner with_look_again(LobbyBanner banner) {
  banner.button = Text::kLobbyLookAgain;
  banner.wish = LobbyWish::kLookAgain;
  return banner;
}

void leave_out_doubles(std::vector<KnownRoom>& rooms) {
  std::vector<KnownRoom> once;
  for (const KnownRoom& room : rooms)
    if (std::none_of(once.begin(), once.end(),
                     [&](const KnownRoom& it) { return is_same_room(it, room); }))
      once.push_back(room);
  rooms = std::move(once);
}

}  // namespace

bool is_same_room(const KnownRoom& a, const KnownRoom& b) {
  return a.room == b.room && without_usual_port(a.server) == without_usual_port(b.server);
}

void LobbyModel::take(const LobbySettings& from) {
  settings = from;
  leave_out_doubles(settings.window.rooms);
  name_typed = settings.shown_name.empty() ? settings.name : settings.shown_name;
  server_typed = settings.server;
  room_typed = settings.room;
  rooms.assign(settings.window.rooms.size(), RoomFact());
  texts = Texts(parse_language(settings.window.language).value_or(language_of_user()));
}

void LobbyModel::take_changes(const LobbySettings& before, const LobbySettings& after) {
  const auto take = [&](auto field) {
    if (before.*field != after.*field) settings.*field = after.*field;
  };
  take(&LobbySettings::shown_name);
  take(&LobbySettings::avatar);
  take(&LobbySettings::look);
  take(&LobbySettings::colour);
  take(&LobbySettings::figure_height);
  take(&LobbySettings::speaks);
  take(&LobbySettings::has_headphones);
  take(&LobbySettings::microphone);
  take(&LobbySettings::loudspeaker);
  name_typed = shown_name();
}

void LobbyModel::show(LobbyScreen to) {
  screen = to;
  is_at_top = true;
  if (to == LobbyScreen::kHost) ask(LobbyWish::kListInvited);
  if (to == LobbyScreen::kShelf) ask(LobbyWish::kListDances);
  shows_command = false;
}

void LobbyModel::forget(Text banner) {
  std::erase_if(banners, [&](const LobbyBanner& it) { return it.text == banner; });
}

void LobbyModel::tell(LobbyBanner banner) {
  // The page scrolls to a new banner.
  is_at_top |= std::find(banners.begin(), banners.end(), banner) == banners.end();
  forget(banner.text);
  banners.insert(banners.begin(), std::move(banner));
  if (banners.size() > kMostBanners) banners.pop_back();
}

// The first request of a frame counts. While a join is going on it can only be cancelled; a join
// request can be confirmed, too.
void LobbyModel::ask(LobbyWish what) {
  const bool ends = what == LobbyWish::kCancel || what == LobbyWish::kQuit;
  if (is_going_in && !ends) return;
  if (join_request && !ends && what != LobbyWish::kConfirmJoin) return;
  if (wish == LobbyWish::kNone) wish = what;
}

void LobbyModel::set_language(Language language) {
  texts = Texts(language);
  for (const LanguageName& it : kLanguages)
    if (it.language == language) settings.window.language = std::string(it.code);
}

void LobbyModel::take_typed_name() {
  const auto id_of = [](const std::string& shown) {
    const std::string id = name_from(shown);
    return id.empty() ? LobbySettings().name : id;
  };
  const auto shown = parse_shown_name(name_typed);
  const bool is_loose =
      settings.window.rooms.empty() && settings.name == id_of(settings.shown_name);
  settings.shown_name = shown ? shown->view() : std::string_view();
  if (is_loose) settings.name = id_of(settings.shown_name);
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
}

bool LobbyModel::is_own_room(const KnownRoom& room) const {
  const auto is_at = [&](const char* here) {
    return is_same_room(room, {room.room, std::string(here) + ":" + std::to_string(host.port)});
  };
  return has_server && (is_at("127.0.0.1") || is_at("localhost") || is_at("[::1]"));
}

void LobbyModel::open_own_room(const KnownRoom& room) {
  settings.room = room_typed = room.room;
  show(LobbyScreen::kHost);
  wish = LobbyWish::kOpenRoom;
}

void LobbyModel::join_known_room(std::size_t which) {
  const KnownRoom room = settings.window.rooms[which];
  const bool is_silent = which < rooms.size() && rooms[which].state == RoomFact::State::kSilent;
  if (is_silent && is_own_room(room) && host.state == HostFacts::State::kClosed)
    return open_own_room(room);
  choose_room(room);
  if (!is_silent) return ask(LobbyWish::kJoin);
  tell({LobbyBanner::Kind::kTrouble,
        Text::kLobbyRoomNotOpen,
        {room.room},
        "",
        Text::kLobbyTryAnyway,
        LobbyWish::kJoin});
}

void LobbyModel::remember_room() {
  if (settings.server.empty()) return;
  auto& known = settings.window.rooms;
  const KnownRoom room{settings.room, settings.server};
  rooms.resize(known.size());
  RoomFact fact;
  if (const auto at = std::find_if(known.begin(), known.end(),
                                   [&](const KnownRoom& it) { return is_same_room(it, room); });
      at != known.end()) {
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
  std::string join = "dance join " + shell_word(settings_path);
  if (settings.window.band != WindowChoices().band) join += " --band " + settings.window.band;
  switch (what) {
    case LobbyWish::kJoin:
      return join;
    case LobbyWish::kAlone:
      return join + " --alone --partner " + shell_word(settings.window.partner);
    case LobbyWish::kPractise: {
      std::string line = join + " --alone";
      if (!settings.window.music.empty()) line += " --music " + shell_word(settings.window.music);
      if (!settings.window.teacher.empty())
        line += " --teacher " + shell_word(settings.window.teacher);
      return settings.window.mirror ? line + " --view mirror" : line;
    }
    case LobbyWish::kOpenRoom:
      return "dance server --bind :: --port " + std::to_string(host.port);
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

bool is_video_file(std::string_view camera) { return is_file_for(ChooserPurpose::kVideo, camera); }

std::optional<LobbyBanner> LobbyModel::find_camera_error(const std::string& camera) const {
  if (!has_camera) return error_banner(Text::kLobbyNoCameraBuilt);
  if (!knows_cameras || is_video_file(camera)) return std::nullopt;
  if (cameras.empty()) return with_look_again(error_banner(Text::kLobbyNoCamera));
  for (const CameraFact& it : cameras)
    if ((camera.empty() || camera == it.path) && !it.trouble.empty())
      return with_look_again(error_banner(Text::kLobbyCameraTaken, {it.path}, it.trouble));
  return std::nullopt;
}

std::optional<LobbyBanner> LobbyModel::find_headset_error() const {
  if (!has_headset) return error_banner(Text::kLobbyNoHeadsetBuilt);
  if (headset_error.empty()) return std::nullopt;
  return with_look_again(error_banner(Text::kLobbyNoHeadset, {}, headset_error));
}

std::optional<LobbyBanner> LobbyModel::start_error(LobbyWish what,
                                                   const LobbySettings& chosen) const {
  using enum DancerSource;
  if (what == LobbyWish::kJoin && !KnownRoom::parse(chosen.room + "@" + chosen.server))
    return error_banner(Text::kLobbyNoRoomYet);
  auto error = chosen.source == kCamera    ? find_camera_error(chosen.camera)
               : chosen.source == kHeadset ? find_headset_error()
                                           : std::nullopt;
  // A guest who only watches needs neither camera nor headset.
  if (error && what == LobbyWish::kJoin && chosen.server == settings.server) {
    error->other_button = Text::kLobbyOnlyWatch;
    error->other_request = LobbyWish::kWatchRoom;
  }
  if (error) return error;
  if (what != LobbyWish::kJoin || !chosen.speaks || sound_error.empty()) return std::nullopt;
  LobbyBanner banner = error_banner(Text::kLobbyMicrophoneUnreachable, {}, sound_error);
  banner.button = Text::kLobbyWithoutVoice;
  banner.wish = LobbyWish::kWithoutVoice;
  return banner;
}

}  // namespace dance
