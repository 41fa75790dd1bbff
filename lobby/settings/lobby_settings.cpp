#include "lobby/settings/lobby_settings.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/plain_number.h"
#include "core/base/text/guest_id_hint.h"
#include "formats/body/look_names.h"
#include "formats/session/table_edit.h"

namespace dance {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

template <class Of>
const Of* of_guest(const std::vector<Of>& all, const GuestId& guest) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Of& it) { return it.guest == guest; });
  return found == all.end() ? nullptr : &*found;
}

// A session's text while it is edited: each call reads it anew, so that places are never stale.
class SessionText {
 public:
  SessionText(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  const std::string& text() const { return text_; }
  Result<HouseConfig> house() const { return parse_session(text_, name_); }

  Result<void> set(const TablePlace& place, const char* key, const std::string& value) {
    return take(set_value(text_, place, key, value, name_));
  }
  Result<void> remove(const TablePlace& place, const char* key) {
    return take(remove_value(text_, place, key, name_));
  }
  Result<void> remove_whole(const TablePlace& place) {
    return take(remove_table(text_, place, name_));
  }
  void append(const char* table, const Values& values) {
    text_ = append_table(text_, table, values);
  }
  // The value, or no such key where it would say nothing.
  Result<void> set_text(const TablePlace& place, const char* key, const std::string& value) {
    return value.empty() ? remove(place, key) : set(place, key, toml_text(value));
  }
  // The first [[table]] of that guest.
  Result<std::optional<TablePlace>> find(const char* table, const std::string& guest) const {
    DANCE_TRY(const auto tables, texts_of_tables(text_, table, name_));
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const auto found = tables[i].find("guest");
      if (found != tables[i].end() && found->second == guest) return TablePlace{table, i};
    }
    return std::optional<TablePlace>();
  }
  Result<std::size_t> count(const char* table) const {
    DANCE_TRY(const auto tables, texts_of_tables(text_, table, name_));
    return tables.size();
  }
  Result<std::map<std::string, std::string>> texts(const TablePlace& place) const {
    DANCE_TRY(auto tables, texts_of_tables(text_, place.table, name_));
    const std::size_t index = place.index.value_or(0);
    return index < tables.size() ? std::move(tables[index]) : std::map<std::string, std::string>();
  }

 private:
  Result<void> take(Result<std::string> edited) {
    if (!edited) return tl::make_unexpected(edited.error());
    text_ = std::move(*edited);
    return {};
  }

  std::string text_;
  std::string name_;
};

#define LOBBY_TRY(call) \
  if (auto done_ = (call); !done_) return done_

const TablePlace kHouseTable{"house", std::nullopt};
const TablePlace kVoiceTable{"voice", std::nullopt};
const TablePlace kWindowTable{"window", std::nullopt};

// Wherever the guest is named, as its dancer, voice or avatar, and in the channels of routes.
Result<void> rename_guest(SessionText& text, const std::string& from, const std::string& to) {
  for (const char* table :
       {"produce", "avatar", "haptics", "style", "channel", "route", "listen"}) {
    DANCE_TRY(const std::size_t count, text.count(table));
    for (std::size_t i = 0; i < count; ++i) {
      const TablePlace place{table, i};
      DANCE_TRY(const auto texts, text.texts(place));
      for (const auto& [key, value] : texts) {
        if (key == "guest" && value == from) LOBBY_TRY(text.set(place, "guest", toml_text(to)));
        const bool is_end = (key == "from" || key == "to") && value.starts_with("POSE/");
        if (is_end && value.ends_with("/" + from))
          LOBBY_TRY(text.set(place, key.c_str(),
                             toml_text(value.substr(0, value.size() - from.size()) + to)));
      }
    }
  }
  for (const char* table : {"voice", "music"}) {
    const TablePlace place{table, std::nullopt};
    DANCE_TRY(const auto texts, text.texts(place));
    const auto found = texts.find("guest");
    if (found != texts.end() && found->second == from)
      LOBBY_TRY(text.set(place, "guest", toml_text(to)));
  }
  return {};
}

Result<void> edit_name(SessionText& text, const HouseConfig& before, const LobbySettings& wanted) {
  const std::string& name = wanted.name;
  if (before.guests.empty()) {
    // A house that only watches stays one until a name is chosen.
    if (name == LobbySettings().name && wanted.shown_name.empty()) return {};
    return text.set(kHouseTable, "guest", toml_text(name));
  }
  const std::string old(before.guests.front().view());
  if (old == name) return {};
  LOBBY_TRY(rename_guest(text, old, name));
  DANCE_TRY(const auto house, text.texts(kHouseTable));
  if (house.contains("guest")) return text.set(kHouseTable, "guest", toml_text(name));
  std::vector<std::string> guests{name};
  for (std::size_t i = 1; i < before.guests.size(); ++i)
    guests.emplace_back(before.guests[i].view());
  return text.set(kHouseTable, "guests", toml_texts(guests));
}

Values produce_values(const LobbySettings& wanted) {
  switch (wanted.source) {
    case DancerSource::kCamera: {
      Values values{{"kind", "\"camera\""}};
      if (!wanted.camera.empty()) values.emplace_back("device", toml_text(wanted.camera));
      if (wanted.height_m > 0.0) values.emplace_back("height", plain_number(wanted.height_m));
      return values;
    }
    case DancerSource::kHeadset:
      // The window of the house shows the stage; a second one is not wanted.
      return {{"kind", "\"headset\""}, {"window", "false"}};
    case DancerSource::kFile:
      return {{"kind", "\"replay\""}, {"file", toml_text(wanted.motion_file)}};
    case DancerSource::kSynthetic:
      return {{"kind", "\"salsa\""}, {"role", toml_text(wanted.role)}};
    case DancerSource::kWatch:
    case DancerSource::kElsewhere:
      break;
  }
  return {};
}

bool has_same_source(const LobbySettings& a, const LobbySettings& b) {
  return a.source == b.source && a.camera == b.camera && a.height_m == b.height_m &&
         a.motion_file == b.motion_file && a.role == b.role;
}

// A watcher keeps the [[produce]] for a later dance.
Result<LobbySettings> edit_watching(SessionText& text, const LobbySettings& now,
                                    const LobbySettings& wanted) {
  const bool watches = wanted.source == DancerSource::kWatch;
  if (watches == (now.source == DancerSource::kWatch)) return now;
  auto done = watches ? text.set(kHouseTable, "watch", "true") : text.remove(kHouseTable, "watch");
  if (!done) return tl::make_unexpected(done.error());
  DANCE_TRY(const HouseConfig house, text.house());
  return settings_of(house);
}

Result<void> edit_source(SessionText& text, const LobbySettings& before,
                         const LobbySettings& wanted) {
  DANCE_TRY(const LobbySettings now, edit_watching(text, before, wanted));
  if (has_same_source(now, wanted) || wanted.source == DancerSource::kElsewhere) return {};
  DANCE_TRY(const auto place, text.find("produce", wanted.name));
  Values values = produce_values(wanted);
  if (now.source != wanted.source) {
    if (place) LOBBY_TRY(text.remove_whole(*place));
    values.insert(values.begin() + 1, {"guest", toml_text(wanted.name)});
    text.append("produce", values);
    return {};
  }
  // Of the same kind: what else stands there stays.
  if (!place || wanted.source == DancerSource::kHeadset) return {};
  if (wanted.source == DancerSource::kCamera) {
    LOBBY_TRY(text.set_text(*place, "device", wanted.camera));
    return wanted.height_m > 0.0 ? text.set(*place, "height", plain_number(wanted.height_m))
                                 : text.remove(*place, "height");
  }
  for (const auto& [key, value] : values) LOBBY_TRY(text.set(*place, key.c_str(), value));
  return {};
}

bool is_file_name(const std::string& avatar) { return avatar.find('/') != std::string::npos; }

bool has_same_figure(const LobbySettings& a, const LobbySettings& b) {
  return a.avatar == b.avatar && a.look == b.look && a.colour == b.colour &&
         a.figure_height == b.figure_height;
}

bool has_chosen_figure(const LobbySettings& settings) {
  return !has_same_figure(settings, LobbySettings());
}

Result<void> edit_avatar(SessionText& text, const LobbySettings& wanted) {
  const auto place = [&] { return text.find("avatar", wanted.name); };
  DANCE_TRY(auto found, place());
  if (!has_chosen_figure(wanted)) return found ? text.remove_whole(*found) : Result<void>();
  if (!found) {
    text.append("avatar", {{"guest", toml_text(wanted.name)}});
    DANCE_TRY(found, place());
  }
  const bool is_file = is_file_name(wanted.avatar);
  LOBBY_TRY(text.set_text(*found, "name", is_file ? "" : wanted.avatar));
  LOBBY_TRY(text.set_text(*found, "file", is_file ? wanted.avatar : ""));
  LOBBY_TRY(text.set_text(*found, "look", wanted.look));
  LOBBY_TRY(text.set_text(*found, "colour", wanted.colour));
  DANCE_TRY(const HouseConfig house, text.house());
  // An equal number in another notation stays as it was written.
  if (settings_of(house).figure_height == wanted.figure_height) return {};
  return wanted.figure_height == 1.0
             ? text.remove(*found, "height")
             : text.set(*found, "height", plain_number(wanted.figure_height));
}

Result<void> edit_voice(SessionText& text, const LobbySettings& wanted) {
  // What else was written there by hand counts again later.
  if (!wanted.speaks) return text.set(kVoiceTable, "enabled", "false");
  LOBBY_TRY(text.remove(kVoiceTable, "enabled"));
  LOBBY_TRY(text.set(kVoiceTable, "headphones", wanted.has_headphones ? "true" : "false"));
  LOBBY_TRY(text.set_text(kVoiceTable, "microphone", wanted.microphone));
  return text.set_text(kVoiceTable, "loudspeaker", wanted.loudspeaker);
}

Result<void> edit_window(SessionText& text, const WindowChoices& now, const WindowChoices& wanted) {
  if (now.language != wanted.language)
    LOBBY_TRY(text.set_text(kWindowTable, "language", wanted.language));
  if (now.rooms != wanted.rooms) {
    std::vector<std::string> rooms;
    for (const KnownRoom& room : wanted.rooms) rooms.push_back(room.text());
    LOBBY_TRY(text.set(kWindowTable, "rooms", toml_texts(rooms)));
  }
  if (now.partner != wanted.partner)
    LOBBY_TRY(text.set(kWindowTable, "partner", toml_text(wanted.partner)));
  if (now.band != wanted.band) LOBBY_TRY(text.set_text(kWindowTable, "band", wanted.band));
  if (now.music != wanted.music) LOBBY_TRY(text.set_text(kWindowTable, "music", wanted.music));
  if (now.mirror != wanted.mirror)
    LOBBY_TRY(text.set(kWindowTable, "mirror", wanted.mirror ? "true" : "false"));
  if (now.teacher != wanted.teacher)
    LOBBY_TRY(text.set_text(kWindowTable, "teacher", wanted.teacher));
  if (now.letters != wanted.letters)
    LOBBY_TRY(wanted.letters == 1.0
                  ? text.remove(kWindowTable, "letters")
                  : text.set(kWindowTable, "letters", plain_number(wanted.letters)));
  if (now.place != wanted.place)
    LOBBY_TRY(text.set(kWindowTable, "place", toml_text(wanted.place)));
  if (now.width_px != wanted.width_px)
    LOBBY_TRY(text.set(kWindowTable, "width", std::to_string(wanted.width_px)));
  if (now.height_px != wanted.height_px)
    LOBBY_TRY(text.set(kWindowTable, "height", std::to_string(wanted.height_px)));
  return {};
}

// Step by step, each only where something is different.
Result<void> edit_all(SessionText& text, const LobbySettings& wanted) {
  DANCE_TRY(const HouseConfig before, text.house());
  LOBBY_TRY(edit_name(text, before, wanted));
  DANCE_TRY(const HouseConfig house, text.house());
  const LobbySettings now = settings_of(house);
  if (now.shown_name != wanted.shown_name)
    LOBBY_TRY(text.set_text(kHouseTable, "shown_name", wanted.shown_name));
  if (now.server != wanted.server) LOBBY_TRY(text.set_text(kHouseTable, "server", wanted.server));
  if (now.room != wanted.room) LOBBY_TRY(text.set(kHouseTable, "room", toml_text(wanted.room)));
  if (!has_same_source(now, wanted)) LOBBY_TRY(edit_source(text, now, wanted));
  if (!has_same_figure(now, wanted)) LOBBY_TRY(edit_avatar(text, wanted));
  const bool is_same_voice =
      now.speaks == wanted.speaks && now.has_headphones == wanted.has_headphones &&
      now.microphone == wanted.microphone && now.loudspeaker == wanted.loudspeaker;
  if (!is_same_voice) LOBBY_TRY(edit_voice(text, wanted));
  return edit_window(text, now.window, wanted.window);
}

#undef LOBBY_TRY

void take_figure(const HostedAvatar& avatar, LobbySettings& settings) {
  const AvatarChoice& choice = avatar.choice;
  settings.figure_height = choice.height;
  const bool is_look = is_look_name(choice.what);
  if (!is_look) settings.avatar = choice.what;
  if (!settings.avatar.empty()) return;
  const bool names_look = !choice.what.empty() && choice.what != kMannequinName;
  settings.look = names_look ? choice.what : choice.look;
  settings.colour = choice.colour;
}

}  // namespace

LobbySettings only_what_counts(const LobbySettings& settings) {
  const LobbySettings plain;
  LobbySettings counts = settings;
  if (settings.source != DancerSource::kCamera) {
    counts.camera = plain.camera;
    counts.height_m = plain.height_m;
  }
  if (settings.source != DancerSource::kFile) counts.motion_file = plain.motion_file;
  if (settings.source != DancerSource::kSynthetic) counts.role = plain.role;
  if (!settings.avatar.empty()) {
    counts.look = plain.look;
    counts.colour = plain.colour;
  }
  if (!settings.speaks) {
    counts.has_headphones = plain.has_headphones;
    counts.microphone = plain.microphone;
    counts.loudspeaker = plain.loudspeaker;
  }
  return counts;
}

bool loses_a_table(const LobbySettings& written, const LobbySettings& later) {
  const bool loses_source = written.source != later.source && later.source != DancerSource::kWatch;
  return loses_source || (has_chosen_figure(written) && !has_chosen_figure(later));
}

LobbySettings settings_of(const HouseConfig& house) {
  LobbySettings settings;
  settings.server = house.server;
  settings.room = house.room;
  settings.window = house.window;
  const GuestId guest = house.guests.empty() ? GuestId() : house.guests.front();
  if (guest.is_set()) settings.name = std::string(guest.view());
  if (const auto shown = house.shown_names.find(guest); shown != house.shown_names.end())
    settings.shown_name = shown->second.view();
  if (house.watch) {
    settings.source = DancerSource::kWatch;
  } else if (const HostedCamera* camera = of_guest(house.cameras, guest)) {
    settings.source = DancerSource::kCamera;
    settings.camera = camera->device;
    settings.height_m = camera->height_m;
  } else if (of_guest(house.headsets, guest) != nullptr) {
    settings.source = DancerSource::kHeadset;
  } else if (const HostedProducer* producer = of_guest(house.producers, guest)) {
    const bool is_file = producer->kind == HostedProducer::Kind::kReplay;
    settings.source = is_file ? DancerSource::kFile : DancerSource::kSynthetic;
    settings.motion_file = producer->file;
    if (!is_file) settings.role = producer->role;
  }
  if (const HostedAvatar* avatar = of_guest(house.avatars, guest)) take_figure(*avatar, settings);
  if (house.voice && house.voice->enabled) {
    settings.speaks = true;
    settings.has_headphones = house.voice->headphones;
    settings.microphone = house.voice->microphone;
    settings.loudspeaker = house.voice->loudspeaker;
  }
  return settings;
}

Result<std::string> edit_settings(std::string_view text, const LobbySettings& wanted,
                                  const std::string& name) {
  const LobbySettings counts = only_what_counts(wanted);
  SessionText edited(text, name);
  if (auto done = edit_all(edited, counts); !done) return tl::make_unexpected(done.error());
  DANCE_TRY(const HouseConfig house, edited.house());
  if (!(settings_of(house) == counts))
    return fail(name +
                " says something in a way that the window cannot change; edit it by hand, or move "
                "it away and choose anew");
  return edited.text();
}

std::string name_from(std::string_view typed) { return suggested_guest_id(typed); }

// A server accepts guests whose ids begin with "ana-" with the key of "ana".
std::string further_name(const std::string& name) {
  const std::string further = name + "-2";
  return GuestId::parse(further) ? further : name;
}

}  // namespace dance
