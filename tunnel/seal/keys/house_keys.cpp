#include "tunnel/seal/keys/house_keys.h"

#include <algorithm>

#include "core/base/take_line.h"

namespace dance {
namespace {

constexpr std::string_view kPrefix = "dance-key:";
constexpr std::size_t kMostServer = 260;  // a name's 253 characters, and a port
constexpr const char* kWholeLine =
    "a key is one line, dance-key:NAME@SERVER/ROOM#KEY, as dance server --new-guest printed it: "
    "paste all of it";
constexpr char kGrantMark = '.';
constexpr std::uint16_t kUsualPort = 7400;

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

bool is_server(std::string_view text) {
  return !text.empty() && text.size() <= kMostServer &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '.' || c == '-' || c == ':' || c == '[' || c == ']' || c == '%' || c == '_';
         });
}

}  // namespace

Result<HouseKey> HouseKey::parse(std::string_view line) {
  line = trimmed(line);
  if (!line.starts_with(kPrefix)) return fail(kWholeLine);
  line.remove_prefix(kPrefix.size());
  const auto hash = line.find('#');
  if (hash == std::string_view::npos) return fail(kWholeLine);
  const std::string_view keys = line.substr(hash + 1);
  const auto mark = keys.find(kGrantMark);
  const auto server_key = PublicKey::parse(keys.substr(0, mark));
  HouseKey made;
  if (mark != std::string_view::npos) made.grant = PrivateKey::parse(keys.substr(mark + 1));
  if (!server_key || made.grant.has_value() != (mark != std::string_view::npos))
    return fail(std::string("the end of the line, after #, is no server's key of 44 characters, or "
                            "what follows it is none of 43; ") +
                kWholeLine);
  made.server_key = *server_key;
  std::string_view rest = line.substr(0, hash);
  if (const auto slash = rest.find('/'); slash != std::string_view::npos) {
    const auto room = GuestId::parse(rest.substr(slash + 1));
    if (!room) return fail(std::string("what stands after / is no room's name; ") + kWholeLine);
    made.room = *room;
    rest = rest.substr(0, slash);
  }
  if (const auto at = rest.find('@'); at != std::string_view::npos) {
    made.server = server_name_of(rest.substr(at + 1), 0);
    // As it is written again, with the brackets that an address may get.
    if (!is_server(rest.substr(at + 1)) || !is_server(made.server))
      return fail(std::string("what stands after @ is no server's name; ") + kWholeLine);
    rest = rest.substr(0, at);
  }
  const auto name = GuestId::parse(rest);
  if (!name) return fail(std::string("the name is none: ") + kGuestIdRule);
  made.name = *name;
  return made;
}

std::string HouseKey::title() const {
  std::string text(name.view());
  if (!server.empty()) text += "@" + server;
  if (room.is_set()) text += "/" + std::string(room.view());
  return text;
}

std::string HouseKey::line() const {
  return std::string(kPrefix) + title() + "#" + server_key.text() +
         (grant ? kGrantMark + grant->text() : "");
}

bool HouseKey::concerns(std::string_view of_server) const {
  const std::string whole = server_name_of(of_server, kUsualPort);
  return !server.empty() && (server == whole || server == whole.substr(0, whole.rfind(':')));
}

Result<HouseKeys> HouseKeys::parse(std::string_view text, const std::string& name) {
  HouseKeys keys;
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::string_view line = take_line(text);
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    const auto key = HouseKey::parse(line);
    const std::string where = name + " line " + std::to_string(number) + ": ";
    if (!key) return fail(where + key.error().what);
    if (keys.keys_.size() == kMost) return fail(where + "more than a thousand keys");
    keys.put(*key);
  }
  return keys;
}

std::string HouseKeys::text() const {
  std::string text =
      "# Dance servers that let this house in. Anyone who reads this can use the keys behind a "
      "dot.\n";
  for (const HouseKey& key : keys_) text += key.line() + "\n";
  return text;
}

void HouseKeys::put(const HouseKey& key) {
  const auto same = std::find_if(keys_.begin(), keys_.end(),
                                 [&](const HouseKey& k) { return k.title() == key.title(); });
  if (same == keys_.end())
    keys_.push_back(key);
  else
    *same = key;
}

bool HouseKeys::remove(std::string_view title) {
  return std::erase_if(keys_, [&](const HouseKey& key) { return key.title() == title; }) > 0;
}

std::vector<std::string> HouseKeys::trust(std::string_view of_server, const PublicKey& server_key) {
  std::vector<std::string> titles;
  for (HouseKey& key : keys_) {
    if (!key.concerns(of_server) || key.server_key == server_key) continue;
    key.server_key = server_key;
    titles.push_back(key.title());
  }
  return titles;
}

const HouseKey* HouseKeys::find_other(std::string_view of_server,
                                      const PublicKey& server_key) const {
  const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const HouseKey& key) {
    return key.concerns(of_server) && key.server_key != server_key;
  });
  return found == keys_.end() ? nullptr : &*found;
}

const HouseKey* HouseKeys::find(std::string_view server, const GuestId& room,
                                const GuestId& guest) const {
  const HouseKey* best = nullptr;
  int best_fit = -1;
  for (const HouseKey& key : keys_) {
    const bool is_of_server = !key.server.empty();
    if (is_of_server && !key.concerns(server)) continue;
    if (key.room.is_set() && key.room != room) continue;
    const bool is_own =
        guest.is_set() &&
        (key.name == guest || guest.view().starts_with(std::string(key.name.view()) + "-"));
    const int fit = (is_own ? 4 : 0) + (is_of_server ? 2 : 0) + (key.room.is_set() ? 1 : 0);
    if (fit <= best_fit) continue;
    best = &key;
    best_fit = fit;
  }
  return best;
}

std::string server_name_of(std::string_view server, std::uint16_t default_port) {
  std::string name(server);
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const bool is_bare_ipv6 =
      std::count(name.begin(), name.end(), ':') > 1 && name.find('[') == std::string::npos;
  if (is_bare_ipv6) name = "[" + name + "]";
  const bool has_port =
      name.find(':', name.find(']') == std::string::npos ? 0 : name.find(']')) != std::string::npos;
  if (!has_port && default_port != 0) name += ":" + std::to_string(default_port);
  return name;
}

std::string host_of(std::string_view server) {
  std::string name = server_name_of(server, 1);
  name = name.substr(0, name.rfind(':'));
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  return name;
}

}  // namespace dance
