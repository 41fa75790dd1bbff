#include "tunnel/invitation/invitation.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>

#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

constexpr std::string_view kScheme = "dance://";
constexpr std::string_view kVersion = "2";
constexpr std::size_t kMostText = 600;
constexpr std::size_t kMostParameters = 16;
constexpr std::size_t kMostHost = 253;
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr const char* kCopyAll =
    "; an invitation is one line, dance://SERVER/ROOM?…, as dance server --invite printed it: copy "
    "all of it, or ask for another";

tl::unexpected<Error> wrong(const std::string& what) { return fail("the invitation " + what); }

char lowered(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view without_space(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

bool begins_with_scheme(std::string_view text) {
  return text.size() >= kScheme.size() &&
         std::equal(kScheme.begin(), kScheme.end(), text.begin(),
                    [](char a, char b) { return a == lowered(b); });
}

std::string_view take_until(std::string_view& text, std::string_view ends) {
  const std::string_view taken = text.substr(0, text.find_first_of(ends));
  text.remove_prefix(taken.size());
  return taken;
}

// %41 to A; nullopt where what follows a % is no such number, or means no printable character.
std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const auto high = kHexDigits.find(lowered(text[i + 1]));
      const auto low = kHexDigits.find(lowered(text[i + 2]));
      if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (c < 0x21 || c > 0x7e) return std::nullopt;
    plain += c;
  }
  return plain;
}

// CRC-32 (IEEE 802.3): finds all that a few wrong, missing or exchanged characters do.
std::string check_of(std::string_view text) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  std::array<char, 9> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x", ~crc);
  return digits.data();
}

bool is_ipv6(std::string_view host) { return host.find(':') != std::string_view::npos; }

bool is_host(std::string_view host) {
  if (host.empty() || host.size() > kMostHost) return false;
  const bool is_number = is_ipv6(host);
  return std::all_of(host.begin(), host.end(), [&](char c) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
    return is_plain || c == '_' || (is_number && (c == ':' || c == '%'));
  });
}

// A % before the interface of a link-local address is written as %25.
std::string written_host(const std::string& host) {
  if (!is_ipv6(host)) return host;
  std::string text = "[";
  for (const char c : host) text += c == '%' ? std::string("%25") : std::string(1, c);
  return text + "]";
}

std::string unchecked_text(const Invitation& it) {
  std::string text(kScheme);
  text += written_host(it.host);
  if (it.port != kInvitationPort) text += ":" + std::to_string(it.port);
  if (it.room.is_set()) text += "/" + std::string(it.room.view());
  text += "?v=" + std::string(kVersion) + "&guest=" + std::string(it.guest.view());
  if (it.role != KeyKind::kGuest) text += "&role=" + std::string(key_kind_name(it.role));
  return text + "&server=" + it.server_key.text() + "&key=" + it.key.text() +
         "&until=" + utc_text(it.until_s);
}

using Parameters = std::map<std::string, std::string, std::less<>>;

Result<Parameters> parameters_of(std::string_view query) {
  constexpr std::array<std::string_view, 7> kKnown{"v",   "guest", "role", "server",
                                                   "key", "until", "check"};
  Parameters found;
  std::size_t count = 0;
  while (!query.empty()) {
    if (++count > kMostParameters) return wrong(std::string("has too many parameters") + kCopyAll);
    std::string_view value = take_until(query, "&");
    if (!query.empty()) query.remove_prefix(1);
    const std::string_view name = take_until(value, "=");
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) {
      // Of a version to come: in capitals what cannot be left aside.
      if (!name.empty() && name.front() >= 'A' && name.front() <= 'Z')
        return wrong("is of a newer version than this program: update DanceGraph");
      continue;
    }
    const auto plain = value.empty() ? std::nullopt : decoded(value.substr(1));
    if (!plain || plain->empty())
      return wrong("has nothing that can be read as " + std::string(name) + kCopyAll);
    if (!found.emplace(name, *plain).second)
      return wrong("names " + std::string(name) + " twice" + kCopyAll);
  }
  return found;
}

}  // namespace

std::string Invitation::server() const {
  return (is_ipv6(host) ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::string Invitation::title() const { return house_key().title(); }

HouseKey Invitation::house_key() const {
  HouseKey made;
  made.name = guest;
  made.server = server();
  made.room = room;
  made.server_key = server_key;
  return made;
}

bool is_invitation(std::string_view text) { return begins_with_scheme(without_space(text)); }

Result<void> set_server(Invitation& invitation, std::string_view server) {
  const std::string shown = server.size() <= kMostHost ? "'" + std::string(server) + "'" : "this";
  const std::string whole = server_name_of(server, kInvitationPort);
  std::string host = host_of(whole);
  const std::string digits = whole.substr(std::min(whole.size(), whole.rfind(':') + 1));
  std::uint16_t port = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (!is_host(host) || digits.empty() || read.ec != std::errc() ||
      read.ptr != digits.data() + digits.size() || port == 0)
    return fail(shown + " is no HOST or HOST:PORT");
  invitation.host = std::move(host);
  invitation.port = port;
  return {};
}

Result<Invitation> parse_invitation(std::string_view text) {
  text = without_space(text);
  if (!begins_with_scheme(text)) return wrong(std::string("does not begin as one") + kCopyAll);
  if (text.size() > kMostText) return wrong(std::string("is longer than any") + kCopyAll);
  text.remove_prefix(kScheme.size());
  Invitation made;
  const auto server = decoded(take_until(text, "/?"));
  if (!server || !set_server(made, *server))
    return wrong(std::string("names no server") + kCopyAll);
  if (text.starts_with('/')) {
    text.remove_prefix(1);
    const auto name = decoded(take_until(text, "?"));
    const auto room = name ? GuestId::parse(*name) : std::nullopt;
    if (!room && !(name && name->empty()))
      return wrong(std::string("names no room that could be") + kCopyAll);
    if (room) made.room = *room;
  }
  if (!text.starts_with('?')) return wrong(std::string("ends after the server") + kCopyAll);
  text.remove_prefix(1);
  DANCE_TRY(const Parameters given, parameters_of(text));
  const auto value = [&](std::string_view name) {
    const auto found = given.find(name);
    return found == given.end() ? std::string_view() : std::string_view(found->second);
  };
  if (value("v").empty()) return wrong(std::string("has no version") + kCopyAll);
  if (value("v") != kVersion) return wrong("is of another version: update DanceGraph");
  const auto guest = GuestId::parse(value("guest"));
  if (!guest) return wrong(std::string("names no guest") + kCopyAll);
  made.guest = *guest;
  if (!value("role").empty()) {
    const auto role = find_key_kind(value("role"));
    if (!role || *role == KeyKind::kRoom)
      return wrong(std::string("names no role that could be") + kCopyAll);
    made.role = *role;
  }
  const auto server_key = PublicKey::parse(value("server"));
  if (!server_key) return wrong(std::string("has no whole key of the server") + kCopyAll);
  made.server_key = *server_key;
  const auto key = PrivateKey::parse(value("key"));
  if (!key) return wrong(std::string("has no whole key") + kCopyAll);
  made.key = *key;
  const auto until_s = parse_utc(value("until"));
  if (!until_s) return wrong(std::string("does not say until when it is good") + kCopyAll);
  made.until_s = *until_s;
  if (value("check") != check_of(unchecked_text(made)))
    return wrong(std::string("has a wrong or missing character somewhere") + kCopyAll);
  return made;
}

std::string text_of(const Invitation& invitation) {
  const std::string text = unchecked_text(invitation);
  return text + "&check=" + check_of(text);
}

}  // namespace dance
