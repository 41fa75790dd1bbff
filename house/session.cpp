#include "house/session.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "consumers/rate_limit.h"
#include "core/base/beat.h"
#include "core/program/whole_file.h"
#include "formats/kind/file_content.h"
#include "formats/session/session_edit.h"
#include "formats/session/toml_places.h"
#include "house/session_guests.h"
#include "house/session_haptics.h"
#include "house/session_producers.h"
#include "house/toml_reader.h"
#include "producers/music/band/band_song.h"
#include "transformers/flow.h"
#include "transformers/style/style_presets.h"

namespace dance {
namespace {

constexpr std::size_t kMaxGuestsPerHouse = 16;
constexpr std::size_t kMaxRoutes = 64;

// "POSE/guest/*" or "POSE/capture/alice".
std::optional<RouteEnd> parse_end(std::string_view text) {
  constexpr std::string_view kPrefix = "POSE/";
  if (!text.starts_with(kPrefix)) return std::nullopt;
  text.remove_prefix(kPrefix.size());
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  RouteEnd end;
  const auto where = find_where(text.substr(0, slash));
  if (!where || *where == Where::kView) return std::nullopt;
  end.where = *where;
  const std::string_view guest = text.substr(slash + 1);
  if (guest == "*") return end;
  const auto id = GuestId::parse(guest);
  if (!id) return std::nullopt;
  end.guest = *id;
  return end;
}

RouteEnd read_end(TomlReader& reader, std::string_view key, const std::string& text) {
  const auto end = parse_end(text);
  if (!end)
    reader.complain(key, "'" + text + "' is not a channel like POSE/guest/* or POSE/capture/alice");
  return end.value_or(RouteEnd());
}

std::string read_file_name(TomlReader& reader, const char* key,
                           const std::filesystem::path& folder) {
  const auto file = reader.maybe_string(key);
  return file ? (folder / *file).string() : "";
}

void read_house(TomlReader& reader, const std::filesystem::path& folder, HouseConfig& session) {
  if (const auto guest = reader.maybe_string("guest"))
    session.guests.push_back(read_guest(reader, "guest", *guest));
  for (const std::string& guest : reader.strings("guests", "[\"alice\", \"ann\"]"))
    session.guests.push_back(read_guest(reader, "guests", guest));
  if (session.guests.size() > kMaxGuestsPerHouse)
    reader.complain("guests", "at most 16 guests dance in one house");
  if (const auto name = reader.maybe_string("shown_name"))
    if (const auto set = set_shown_name(session, *name); !set)
      reader.complain("shown_name", set.error().what);
  for (const std::string& name : reader.strings("shown_names", "[\"ann=Ann\", \"bob=Bob\"]"))
    if (const auto set = set_shown_name(session, name); !set)
      reader.complain("shown_names", set.error().what);
  session.room = reader.string_or("room", session.room);
  if (!GuestId::parse(session.room))
    reader.complain("room", "a room's name is 1 to 24 characters of a-z, 0-9 and '-'");
  session.server = reader.string_or("server", "");
  session.key_file = read_file_name(reader, "key_file", folder);
  session.certificate = read_file_name(reader, "certificate", folder);
  session.private_key = read_file_name(reader, "private_key", folder);
  session.authorities = read_file_name(reader, "authorities", folder);
  session.bus = reader.string_or("bus", "");
  for (const std::string& guest : reader.strings("bus_captures", "[\"alice\"]"))
    session.bus_captures.push_back(read_guest(reader, "bus_captures", guest));
  session.view = reader.bool_or("view", true);
  session.watch = reader.bool_or("watch", false);
  session.quality_mm = reader.number_or("quality_mm", session.quality_mm, 0.125, 20.0);
  session.pose_bytes_per_second = reader.number_or("pose_bytes_per_second", 0.0, 0.0, 1e6);
  session.avatar_bytes_per_second =
      reader.number_or("avatar_bytes_per_second", session.avatar_bytes_per_second, 0.0, 1e7);
  const auto interest = parse_interest(reader.strings("want", "[\"default=4\", \"bob=1\"]"));
  if (interest)
    session.interest = *interest;
  else
    reader.complain("want", interest.error().what);
  const auto hearing = parse_hearing(reader.strings("hear", "[\"default=0\", \"bob=1\"]"));
  if (hearing)
    session.hearing = *hearing;
  else
    reader.complain("hear", hearing.error().what);
  reader.finish();
}

// A file's name is taken from the folder of the session file; whether it can be read is told when
// the house opens.
void read_avatar_choice(TomlReader& reader, const std::filesystem::path& folder,
                        HouseConfig& session) {
  HostedAvatar avatar;
  avatar.guest = read_guest(reader, "guest", reader.required_string("guest"));
  const std::string file = read_file_name(reader, "file", folder);
  avatar.choice.what = reader.string_or("name", "");
  if (!file.empty() && !avatar.choice.what.empty())
    reader.complain("name", "an avatar has a file or a name, not both");
  if (!file.empty()) avatar.choice.what = file.find('/') == std::string::npos ? "./" + file : file;
  avatar.choice.look = reader.string_or("look", "");
  avatar.choice.colour = reader.string_or("colour", "");
  avatar.choice.height = reader.number_or("height", 1.0, 0.25, 4.0);
  reader.finish();
  session.avatars.push_back(avatar);
}

void read_route(TomlReader& reader, HouseConfig& session) {
  Route route;
  route.from = read_end(reader, "from", reader.required_string("from"));
  route.to = read_end(reader, "to", reader.required_string("to"));
  route.through = reader.strings("through", "[\"hold 20ms\"]");
  const auto flow = Flow::make(route.through);
  if (!flow) reader.complain("through", flow.error().what);
  // Without a rate, poses go on as they come; transformers need the stage's steady rate.
  const bool is_plain = !flow || flow->is_pass_through();
  route.rate_hz = reader.number_or("rate", is_plain ? 0.0 : 60.0, 0.0, 1000.0);
  if (!is_plain && route.rate_hz < 1.0)
    reader.complain("rate", "a route with transformers needs a rate from 1 to 1000 Hz");
  if (is_plain && route.rate_hz > 0.0)
    reader.complain("rate",
                    "a route without transformers gives poses on as they come; add \"hold 0ms\" "
                    "for a steady rate");
  if (route.to.where != Where::kStage) reader.complain("to", "a route leads to POSE/stage");
  if (route.from.where == Where::kStage)
    reader.complain("from", "a route from the stage to the stage would run in a circle");
  if (route.to.guest.is_set() && !route.from.guest.is_set())
    reader.complain("to", "all guests cannot become one; write POSE/stage/*");
  reader.finish();
  session.routes.push_back(route);
}

void read_consumer(TomlReader& reader, const std::filesystem::path& folder, HouseConfig& session) {
  HostedConsumer consumer;
  consumer.to = reader.required_string("to");
  consumer.from = read_end(reader, "from", reader.string_or("from", "POSE/stage/*"));
  if (consumer.from.where == Where::kGuest)
    reader.complain("from", "a hosted consumer hears POSE/stage or POSE/capture");
  ConsumerOptions& options = consumer.options;
  options.guest = consumer.from.guest;
  options.file = read_file_name(reader, "file", folder);
  options.address = reader.string_or("address", "");
  options.name = reader.string_or("name", "");
  options.dialect = reader.string_or("dialect", "");
  options.hz = reader.number_or("rate", 0.0, 0.0, kFastestRate_hz);
  if (const auto rate = check_rate(options.hz); !rate) reader.complain("rate", rate.error().what);
  const ConsumerKind* kind = find_consumer_kind(consumer.to);
  if (!kind)
    reader.complain("to", fmt::format("is one of: {}", fmt::join(consumer_names(), ", ")));
  else if (const auto checked = check_consumer_options(*kind, options); !checked)
    reader.complain("to", checked.error().what);
  reader.finish();
  session.consumers.push_back(consumer);
}

void read_music(TomlReader& reader, const std::filesystem::path& folder, HouseConfig& session) {
  HostedMusic music;
  const bool has_room = !session.server.empty();
  music.band = reader.string_or("band", "");
  const bool has_band = !music.band.empty() && music.band != kNoBand;
  if (has_band && !band_style_of(music.band))
    reader.complain("band", "is one of: " + band_style_names() + ", none");
  music.file = read_file_name(reader, "file", folder);
  music.beats = read_file_name(reader, "beats", folder);
  music.microphone = reader.bool_or("microphone", false);
  music.follow = reader.bool_or("follow", has_room && !music.microphone);
  if (const auto guest = reader.maybe_string("guest"))
    music.guest = read_guest(reader, "guest", *guest);
  else if ((has_band || !music.file.empty()) && !session.guests.empty())
    music.guest = session.guests.front();
  music.is_alone = !has_room && !music.follow && !music.file.empty();
  music.loop = reader.bool_or("loop", false);
  music.silent = reader.bool_or("silent", false);
  music.volume = reader.number_or("volume", has_band ? HostedMusic::kBandVolume : 1.0, 0.0, 1.0);
  music.steps_bpm = reader.number_or("steps_bpm", 0.0, 0.0, 400.0);
  if (music.steps_bpm > 0.0 && music.steps_bpm < kLeastTempo_bpm)
    reader.complain("steps_bpm", "is slower than anybody steps: 0, or 20 to 400");
  music.trim_ms = reader.number_or("trim_ms", 0.0, -5000.0, 5000.0);
  reader.finish();  // first, so that a misspelt key is told from a missing one
  if (music.band == kNoBand) {
    session.has_no_band = true;
    music.band.clear();
    if (music.file.empty() && !music.microphone) return;
  }
  if (has_band && (!music.file.empty() || music.microphone))
    reader.complain("band", "plays in the place of a file or a microphone: leave one of them out");
  if (music.file.empty() && !music.follow && !music.microphone && !has_band)
    reader.complain("file",
                    "is missing: name the music, or write band = \"salsa\", follow = true or "
                    "microphone = true");
  session.music = music;
}

// The words of --channel as keys; numbers and truths stand as such.
void read_channel(TomlReader& reader, HouseConfig& session) {
  const std::string name = reader.required_string("name");
  ChannelRule::Words words;
  for (const char* key : {"class", "direction", "layout", "fingerprint", "guest"})
    if (const auto value = reader.maybe_string(key)) words.emplace_back(key, *value);
  constexpr auto kMostBytes = static_cast<std::int64_t>(kMaxChannelNewestBytes);
  const std::int64_t size = reader.integer_or("size", 0, 1, kMostBytes);
  if (size > 0) words.emplace_back("size", std::to_string(size));
  const double rate = reader.number_or("rate", 0.0, 0.1, kMaxChannelRate_hz);
  if (rate > 0.0) words.emplace_back("rate", std::to_string(rate));
  if (reader.bool_or("unchecked", false)) words.emplace_back("unchecked", "yes");
  reader.finish();  // first, so that a misspelt key is told from a missing one
  const auto rule = ChannelRule::of(name, words);
  if (!rule) reader.complain("name", rule.error().what);
  if (session.channels.size() == kMaxChannelRules)
    reader.complain("name", "a house has at most " + std::to_string(kMaxChannelRules) +
                                " channels; join some, as LIGHT/*");
  if (rule) session.channels.push_back(*rule);
}

void read_style_of(TomlReader& reader, HouseConfig& session) {
  HostedStyle style;
  style.guest = read_guest(reader, "guest", reader.required_string("guest"));
  const std::string text = reader.required_string("words");
  std::vector<std::string_view> words;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (end > 0) words.push_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  // All of the motion, as `dance style` has it.
  if (const auto read = read_style("style", words, 1.0))
    style.style = *read;
  else
    reader.complain("words", read.error().what);
  reader.finish();
  session.styles.push_back(style);
}

void read_voice_of(TomlReader& reader, HouseConfig& session) {
  session.voice = read_voice(reader, session.guests.empty() ? GuestId() : session.guests.front());
  if (!session.voice->names_guest) return;
  const std::string trouble = trouble_of_speaking(session, session.voice->guest);
  if (!trouble.empty()) reader.complain("guest", trouble);
}

// Calls `read` for each table of an array of tables; the first problem ends it.
template <class Read>
std::optional<Error> read_each(const toml::table& document, std::string_view key,
                               const std::string& name, Read read) {
  const toml::node* node = document.get(key);
  if (!node) return std::nullopt;
  const toml::array* array = node->as_array();
  if (!array || !array->is_array_of_tables() || array->size() > kMaxRoutes) {
    const auto begin = node->source().begin;
    return Error{name + ":" + std::to_string(begin.line) + ":" + std::to_string(begin.column) +
                 ": write " + std::string(key) + " as [[" + std::string(key) + "]], at most " +
                 std::to_string(kMaxRoutes) + " times"};
  }
  for (const toml::node& element : *array) {
    TomlReader reader(*element.as_table(), name, "[[" + std::string(key) + "]]");
    read(reader);
    if (reader.problem()) return reader.problem();
  }
  return std::nullopt;
}

template <class Read>
std::optional<Error> read_once(const toml::table& document, const std::string& key,
                               const std::string& name, Read read) {
  const toml::node* node = document.get(key);
  if (!node) return std::nullopt;
  const auto begin = node->source().begin;
  if (!node->is_table())
    return Error{name + ":" + std::to_string(begin.line) + ":" + std::to_string(begin.column) +
                 ": write " + key + " as [" + key + "], once"};
  TomlReader reader(*node->as_table(), name, "[" + key + "]");
  read(reader);
  return reader.problem();
}

std::optional<Error> read_document(const toml::table& document, const std::string& name,
                                   HouseConfig& session) {
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  for (const auto& [key, node] : document) {
    const std::string_view k = key.str();
    if (k != "house" && k != "route" && k != "produce" && k != "listen" && k != "haptics" &&
        k != "channel" && k != "music" && k != "voice" && k != "style" && k != "avatar" &&
        k != "window")
      return Error{
          name + ":" + std::to_string(key.source().begin.line) + ":" +
          std::to_string(key.source().begin.column) + ": there is no '" + std::string(k) +
          "' in a session file; there are [house], [[route]], [[produce]], "
          "[[listen]], [[haptics]], [[channel]], [[avatar]], [[style]], [music], [voice] and "
          "[window]"};
  }
  const toml::node* house = document.get("house");
  if (!house || !house->is_table()) return Error{name + ":1:1: the table [house] is missing"};
  TomlReader reader(*house->as_table(), name, "[house]");
  read_house(reader, folder, session);
  if (reader.problem()) return reader.problem();
  auto problem = read_each(document, "route", name, [&](TomlReader& r) { read_route(r, session); });
  if (!problem)
    problem = read_each(document, "produce", name,
                        [&](TomlReader& r) { read_producer(r, folder, session); });
  if (!problem)
    problem = read_each(document, "listen", name,
                        [&](TomlReader& r) { read_consumer(r, folder, session); });
  if (!problem)
    problem =
        read_each(document, "haptics", name, [&](TomlReader& r) { read_haptics(r, session); });
  if (!problem)
    problem = read_each(document, "style", name, [&](TomlReader& r) { read_style_of(r, session); });
  if (!problem)
    problem =
        read_each(document, "channel", name, [&](TomlReader& r) { read_channel(r, session); });
  if (!problem)
    problem = read_each(document, "avatar", name,
                        [&](TomlReader& r) { read_avatar_choice(r, folder, session); });
  if (!problem)
    problem =
        read_once(document, "music", name, [&](TomlReader& r) { read_music(r, folder, session); });
  if (!problem)
    problem = read_once(document, "window", name, [&](TomlReader& r) {
      session.practice_volume = r.number_or("volume", 1.0, 0.0, 1.0);
      session.window = read_window(r, folder.string());
    });
  if (session.music) session.practice_volume = session.music->volume;
  if (problem) return problem;
  return read_once(document, "voice", name, [&](TomlReader& r) { read_voice_of(r, session); });
}

}  // namespace

Result<HouseConfig> parse_session(std::string_view text, const std::string& name) {
  return with_toml(text, name, [&](const toml::table& document) -> Result<HouseConfig> {
    HouseConfig session;
    if (auto problem = read_document(document, name, session))
      return tl::make_unexpected(std::move(*problem));
    if (session.routes.empty()) session.routes = default_routes();
    return session;
  });
}

Result<HouseConfig> load_session(const std::string& path) {
  constexpr std::string_view kWanted = "a session file";
  if (auto checked = check_content(path, {FileContent::kSessionFile}, kWanted); !checked)
    return tl::make_unexpected(checked.error());
  DANCE_TRY(const std::string text, read_whole_file(path, kMaxSessionBytes));
  return parse_session(text, path);
}

std::vector<Route> default_routes() {
  std::vector<Route> routes;
  for (const RouteText& text : usual_routes())
    routes.push_back({*parse_end(text.from), *parse_end(text.to), text.through, text.rate_hz});
  return routes;
}

}  // namespace dance
