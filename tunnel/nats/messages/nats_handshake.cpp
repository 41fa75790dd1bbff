#include "tunnel/nats/messages/nats_handshake.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/printable.h"
#include "core/net/mono_clock.h"
#include "tunnel/nats/nats_credentials.h"

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
    DANCE_TRY(const NatsProof proof,
              prove_nats_user(options.credentials, nonce->get<std::string>()));
    said["jwt"] = proof.jwt;
    said["sig"] = proof.signature;
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
    if (answer.starts_with("-ERR 'Authorization"))
      return fail("does not let us in: " + cure_of_nats_refusal(options));
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
