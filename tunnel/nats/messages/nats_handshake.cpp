#include "tunnel/nats/messages/nats_handshake.h"

#include <nats/nats.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/printable.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr std::uint16_t kNatsPort = 4222;
constexpr Duration kConnectTimeout = Duration::s(2);  // to each address
constexpr std::size_t kMostAddresses = 4;
constexpr Duration kHandshakeTimeout = Duration::s(3);  // TLS and all that is said before messages
constexpr Duration kWriteTurn = Duration::ms(1);
constexpr std::size_t kMostGreetingBytes = 65'536;

struct NatsUrl {
  std::string user;  // or a token, where there is no password
  std::optional<std::string> password;
  std::string host;  // without the port
  std::string place;
};

NatsUrl parts_of(const std::string& url) {
  NatsUrl parts;
  const std::size_t scheme = url.find("://");
  parts.place = scheme == std::string::npos ? url : url.substr(scheme + 3);
  parts.place = parts.place.substr(0, parts.place.find('/'));
  if (const std::size_t at = parts.place.rfind('@'); at != std::string::npos) {
    parts.user = parts.place.substr(0, at);
    parts.place = parts.place.substr(at + 1);
    if (const std::size_t colon = parts.user.find(':'); colon != std::string::npos) {
      parts.password = parts.user.substr(colon + 1);
      parts.user.resize(colon);
    }
  }
  const std::size_t bracket = parts.place.find(']');
  const std::size_t colon = parts.place.rfind(':');
  parts.host = parts.place;
  if (colon != std::string::npos && (bracket == std::string::npos || colon > bracket) &&
      (bracket != std::string::npos || parts.place.find(':') == colon))
    parts.host = parts.place.substr(0, colon);
  if (parts.host.starts_with('[') && parts.host.ends_with(']'))
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  return parts;
}

// Without padding, for URLs.
std::string base64_of(std::span<const unsigned char> bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                                   static_cast<int>(bytes.size()));
  text.resize(std::min(static_cast<std::size_t>(size), text.find('=')));
  std::replace(text.begin(), text.end(), '+', '-');
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
}

// The lines behind the first and the second -----BEGIN: a user's JWT and its seed.
Result<std::pair<std::string, std::string>> read_credentials(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::string> found;
  bool is_next = false;
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (is_next && !line.empty()) found.push_back(line);
    is_next = line.starts_with("-----BEGIN") || (is_next && line.empty());
    OPENSSL_cleanse(line.data(), line.size());
  }
  if (found.size() != 2)
    return fail("--cluster-credentials " + printable(path) + " is no file of a NATS user");
  return std::pair(found[0], found[1]);
}

Result<void> add_credentials(const NatsOptions& options, const std::string& nonce,
                             nlohmann::json& said) {
  DANCE_TRY(auto credentials, read_credentials(options.credentials));
  unsigned char* signature = nullptr;
  int size = 0;
  const natsStatus status = nats_Sign(credentials.second.c_str(), nonce.c_str(), &signature, &size);
  OPENSSL_cleanse(credentials.second.data(), credentials.second.size());
  if (status != NATS_OK)
    return fail("--cluster-credentials " + printable(options.credentials) + ": no seed of a user");
  said["jwt"] = credentials.first;
  said["sig"] = base64_of({signature, static_cast<std::size_t>(size)});
  std::free(signature);
  return {};
}

class Handshaker {
 public:
  Handshaker(NatsChannel& channel, const NatsDeadline& deadline)
      : channel_(channel), deadline_(deadline) {}

  Result<void> say(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      const auto rest = text.substr(at);
      const auto sent =
          channel_.write({reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()});
      if (!sent) return fail("ends the connection");
      at += *sent;
      if (deadline_.is_over()) return fail("does not read");
      if (*sent == 0) channel_.wait_for_bytes(kWriteTurn);
    }
    return {};
  }
  Result<std::string> line() {
    for (;;) {
      if (const std::size_t end = heard_.find('\n'); end != std::string::npos) {
        std::string said = heard_.substr(0, end);
        heard_.erase(0, end + 1);
        if (said.ends_with('\r')) said.pop_back();
        return said;
      }
      const std::size_t before = heard_.size();
      if (in_all_ >= kMostGreetingBytes) return fail("is no NATS server");
      if (deadline_.is_over()) return fail("does not answer");
      heard_.resize(before + 4096);
      const auto count =
          channel_.read({reinterpret_cast<std::uint8_t*>(heard_.data()) + before, 4096});
      heard_.resize(before + count.value_or(0));
      if (!count) return fail("ends the connection");
      in_all_ += *count;
      if (*count == 0) channel_.wait_for_bytes(deadline_.slice());
    }
  }
  bool has_unread() const { return !heard_.empty(); }
  std::vector<std::uint8_t> unread() const { return {heard_.begin(), heard_.end()}; }

 private:
  NatsChannel& channel_;
  const NatsDeadline& deadline_;
  std::string heard_;
  std::size_t in_all_ = 0;  // bytes that came
};

Result<std::string> introduction(const NatsOptions& options, const NatsUrl& parts,
                                 const nlohmann::json& info, bool is_tls) {
  // Its own messages would come back.
  nlohmann::json said{{"verbose", false}, {"pedantic", false},       {"echo", false},
                      {"protocol", 1},    {"headers", false},        {"tls_required", is_tls},
                      {"lang", "c++"},    {"version", "dancegraph"}, {"name", options.name}};
  if (parts.password) {
    said["user"] = parts.user;
    said["pass"] = *parts.password;
  } else if (!parts.user.empty()) {
    said["auth_token"] = parts.user;
  }
  if (!options.credentials.empty()) {
    const auto nonce = info.find("nonce");
    if (nonce == info.end() || !nonce->is_string()) return fail("asks for no credentials");
    if (auto added = add_credentials(options, nonce->get<std::string>(), said); !added)
      return tl::make_unexpected(added.error());
  }
  return "CONNECT " + said.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
         "\r\nPING\r\n";
}

bool is_said(const nlohmann::json& info, const char* what) {
  const auto found = info.find(what);
  return found != info.end() && found->is_boolean() && found->get<bool>();
}

Result<TcpSocket> connect_to(const Address& address, const NatsDeadline& deadline) {
  DANCE_TRY(TcpSocket made, TcpSocket::begin(address));
  while (!made.wait_for_room(deadline.slice()))
    if (deadline.is_over()) return fail(address.to_string() + ": does not answer");
  if (auto done = made.finish(address); !done) return tl::make_unexpected(done.error());
  return made;
}

// A name may have addresses that lead nowhere from here.
Result<TcpSocket> connect_to_any(const std::string& place, const std::atomic<bool>& ends) {
  DANCE_TRY(const auto addresses, Address::resolve_all(place, kNatsPort));
  Result<TcpSocket> made = fail("has no address");
  for (std::size_t i = 0; i < std::min(addresses.size(), kMostAddresses) && !made && !ends; ++i)
    made = connect_to(addresses[i], NatsDeadline(kConnectTimeout, ends));
  return made;
}

Result<NatsHandshake> open_at(const NatsOptions& options, const NatsUrl& parts,
                              const std::atomic<bool>& ends) {
  DANCE_TRY(TcpSocket socket, connect_to_any(parts.place, ends));
  NatsChannel channel(std::move(socket));
  const NatsDeadline deadline(kHandshakeTimeout, ends);
  Handshaker handshaker(channel, deadline);
  DANCE_TRY(const std::string hello, handshaker.line());
  const nlohmann::json info = hello.starts_with("INFO ")
                                  ? nlohmann::json::parse(hello.substr(5), nullptr, false)
                                  : nlohmann::json(nlohmann::json::value_t::discarded);
  if (!info.is_object()) return fail("is no NATS server");
  const bool asks = is_said(info, "tls_required");
  if (wants_tls(options) && !asks && !is_said(info, "tls_available"))
    return fail(std::string("no TLS: the server offers none: ") + kTlsIsWanted);
  // What was said before TLS is anyone's word: it may ask for TLS, and never against it.
  const bool is_tls = asks || wants_tls(options);
  if (is_tls) {
    if (handshaker.has_unread()) return fail("no TLS: more than its greeting came before it");
    if (auto started = channel.start_tls(options, parts.host, deadline); !started)
      return tl::make_unexpected(started.error());
  }
  DANCE_TRY(const std::string who, introduction(options, parts, info, is_tls));
  if (auto said = handshaker.say(who); !said) return tl::make_unexpected(said.error());
  for (;;) {
    DANCE_TRY(const std::string answer, handshaker.line());
    if (answer.starts_with("PONG")) break;
    if (answer.starts_with("-ERR")) return fail(printable(answer));
  }
  return NatsHandshake{std::move(channel), handshaker.unread()};
}

}  // namespace

Result<NatsHandshake> handshake_nats(const NatsOptions& options, const std::string& url,
                                     const std::atomic<bool>& ends) {
  const NatsUrl parts = parts_of(url);
  auto opened = open_at(options, parts, ends);
  if (!opened) return fail("NATS at " + printable(parts.place) + ": " + opened.error().what);
  return opened;
}

}  // namespace dance
