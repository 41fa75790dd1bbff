#include "tunnel/seal/seal_server.h"

#include <cstring>

#include "core/base/assert.h"

namespace dance {
namespace {

// During a flood, beyond the common rate.
constexpr double kKnownDatagramsPerSecond = 2000.0, kKnownDatagramBurst = 1000.0;
constexpr Duration kTickOfNewcomers = Duration::ms(2);
constexpr Duration kTickOfHandshakes = Duration::ms(50);
constexpr Duration kTickOfPeers = Duration::s(1);
constexpr Duration kSecretsStand = Duration::s(60);

}  // namespace

void SealServer::CountingSink::send(const Address& to, std::span<const std::uint8_t> bytes) {
  ++counters_.datagrams_out;
  counters_.bytes_out += bytes.size();
  sink_.send(to, bytes);
}

Result<std::unique_ptr<SealServer>> SealServer::make(
    const SealLimits& limits, const PrivateKey& identity, std::shared_ptr<const KeyRing> keys,
    const std::optional<SealCertificates>& certificates, RandomU64 random, Handlers handlers,
    DatagramSink& sink) {
  auto server = std::unique_ptr<SealServer>(new SealServer(
      limits, identity, std::move(keys), std::move(random), std::move(handlers), sink));
  SealServer* self = server.get();
  SealContext::Cookies cookies;
  cookies.make = [self](ssl_st* ssl, std::uint8_t* out) {
    return self->make_cookie(SealChannel::of(ssl), 0, out);
  };
  cookies.check = [self](ssl_st* ssl, const std::uint8_t* cookie, std::size_t size) {
    return self->is_cookie(SealChannel::of(ssl), cookie, size);
  };
  DANCE_TRY(server->context_,
            SealContext::for_server(
                identity.public_key(),
                [self](ssl_st* ssl, std::string_view name) { return self->find_key(ssl, name); },
                std::move(cookies), certificates));
  return server;
}

SealServer::SealServer(const SealLimits& limits, const PrivateKey& identity,
                       std::shared_ptr<const KeyRing> keys, RandomU64 random, Handlers handlers,
                       DatagramSink& sink)
    : limits_(limits),
      identity_(identity),
      server_key_(identity.public_key()),
      nobody_(PrivateKey::make().public_key()),
      keys_(std::move(keys)),
      random_(std::move(random)),
      handlers_(std::move(handlers)),
      sink_(sink, counters_),
      strangers_(limits.strangers, random_()),
      notices_(limits.notices, random_()),
      cookies_(limits.cookies, random_()),
      newcomers_(limits.newcomers, random_()),
      turns_(random_()),
      recent_(random_()),
      begun_(limits.handshakes_per_second, limits.handshake_burst),
      begun_known_(limits.handshakes_per_second, limits.handshake_burst),
      known_datagrams_(kKnownDatagramsPerSecond, kKnownDatagramBurst) {
  peers_.reserve(limits.peers);
  handshakes_.reserve(limits.handshakes);
  handshake_networks_.reserve(limits.handshakes);
  for (auto& secret : secrets_)
    for (std::uint64_t& word : secret) word = random_();
}

SealServer::~SealServer() {
  for (auto& [id, peer] : peers_) peer.channel->close();
}

bool SealServer::may(SourceLimits& limits, const Address& from, MonoTime now) {
  switch (limits.take(from, now)) {
    case SourceLimits::Answer::kYes:
      return true;
    case SourceLimits::Answer::kSourceHadEnough:
      reject(SealReject::kStrangerRate);
      return false;
    case SourceLimits::Answer::kAllHadEnough:
      break;
  }
  reject(SealReject::kCrowdRate);
  return false;
}

bool SealServer::may_newcomer(SourceLimits& limits, const Address& from, MonoTime now) {
  const SourceLimits::Answer answer = limits.take(from, now);
  if (answer == SourceLimits::Answer::kYes) return true;
  if (answer == SourceLimits::Answer::kAllHadEnough && recent_.contains(from, now) &&
      known_datagrams_.take(1.0, now))
    return true;
  reject(answer == SourceLimits::Answer::kAllHadEnough ? SealReject::kCrowdRate
                                                       : SealReject::kStrangerRate);
  return false;
}

void SealServer::refuse(const Address& from, std::string_view name, SealReject cause) {
  reject(cause);
  if (handlers_.on_refused) handlers_.on_refused(from, name, cause);
}

void SealServer::receive(const Address& from, seal::Bytes datagram, MonoTime received,
                         MonoTime now) {
  ++counters_.datagrams_in;
  counters_.bytes_in += datagram.size();
  if (seal::is_old_hello(datagram)) return on_old_version(from, datagram, now);
  const auto opening = seal::parse(datagram);
  if (!opening) return reject(SealReject::kTooShort);
  switch (opening->form) {
    case seal::Form::kCompact:
      return on_compact(from, *opening, received, now);
    case seal::Form::kRecords:
      return on_records(from, *opening, now);
    case seal::Form::kNotice:
      return reject(SealReject::kMalformed);
  }
}

void SealServer::on_compact(const Address& from, const seal::Opening& opening, MonoTime received,
                            MonoTime now) {
  const auto session = find_session(opening.id);
  if (!session) return answer_unknown(from, opening.id, now);
  Peer& peer = *session->peer;
  const PeerId id = session->id;
  seal::Bytes plain;
  switch (session->channel->open(opening.body, plain)) {
    case SealChannel::Opened::kForged:
      return reject(SealReject::kForged);
    case SealChannel::Opened::kReplayed:
      return reject(SealReject::kReplayed);
    case SealChannel::Opened::kClosed:
      return session->is_current() ? end(id) : forget_previous(peer);
    case SealChannel::Opened::kPlain:
      break;
  }
  peer.last_heard = now;
  // Only what is newer than all before says where the peer is now.
  if (session->is_current() && peer.channel->is_newest() && peer.channel->peer() != from &&
      !on_moved(peer, from))
    return;
  if (is_path_answer(peer, from, plain)) return;
  if (!peer.is_proven && peer.channel->peer() == from)
    ask_path(id, peer, seal::kIdBytes + opening.body.size(), now);
  if (peer.is_invited || plain[0] == seal::kRekey) {
    if (!peer.control.take(1.0, now)) return reject(SealReject::kControlRate);
    return peer.is_invited ? on_invited(id, peer, plain) : on_rekey(id, peer, plain, now);
  }
  handlers_.on_datagram(id, peer.key, plain, received, now);
}

// An invitation opens no room: it only lets the house become the guest that was invited.
void SealServer::on_invited(PeerId id, const Peer& peer, seal::Bytes plain) {
  if (plain.size() != seal::kBindingRequestBytes || plain[0] != seal::kBindingRequest)
    return reject(SealReject::kMalformed);
  const KeyEntry key = peer.key;  // the answer may end the peer
  const PublicKey house = peer.house;
  if (handlers_.on_binding)
    handlers_.on_binding(id, key, house);
  else
    answer_binding(id, Binding::kNotHere);
}

void SealServer::answer_binding(PeerId to, Binding binding) {
  const std::array<std::uint8_t, seal::kBindingAnswerBytes> answer{
      seal::kBindingAnswer, static_cast<std::uint8_t>(binding)};
  send(to, answer);
}

// To another address the peer goes on at once, and hears at most three times what it says until it
// has shown that it hears there: else any guest could aim a room's poses at anybody.
bool SealServer::on_moved(Peer& peer, const Address& from) {
  if (peer.key.is_local() && !from.is_loopback()) {
    reject(SealReject::kNotLocal);
    return false;
  }
  ++counters_.moves;
  peer.channel->set_peer(from);
  peer.is_proven = from == peer.proven;
  peer.asked_at = MonoTime();
  peer.may_hear = 0;
  peer.question = random_();
  return true;
}

void SealServer::ask_path(PeerId id, Peer& peer, std::size_t heard, MonoTime now) {
  constexpr Duration kAskAgain = Duration::ms(100);
  peer.may_hear += 3 * heard;
  if (peer.asked_at.is_set() && now - peer.asked_at < kAskAgain) return;
  peer.asked_at = now;
  std::array<std::uint8_t, seal::kPathBytes> question{seal::kPathQuestion};
  std::memcpy(question.data() + 1, &peer.question, sizeof peer.question);
  send(id, question);
}

bool SealServer::is_path_answer(Peer& peer, const Address& from, seal::Bytes plain) {
  if (plain[0] != seal::kPathAnswer) return false;
  const bool is_it = !peer.is_proven && from == peer.channel->peer() &&
                     plain.size() == seal::kPathBytes &&
                     std::memcmp(plain.data() + 1, &peer.question, sizeof peer.question) == 0;
  if (is_it) {
    peer.is_proven = true;
    peer.proven = from;
  }
  return true;
}

// Lets a link notice at once that the server began anew. Anybody could say so: a link that hears it
// asks for another session, and keeps the one that it has until that stands.
void SealServer::answer_unknown(const Address& from, std::uint64_t id, MonoTime now) {
  reject(SealReject::kUnknownId);
  if (!may(notices_, from, now)) return;
  std::array<std::uint8_t, seal::kIdBytes> out;
  seal::write_opening(id, seal::Form::kNotice, out);
  sink_.send(from, out);
}

void SealServer::on_old_version(const Address& from, seal::Bytes datagram, MonoTime now) {
  reject(SealReject::kOldVersion);
  if (!may(notices_, from, now)) return;
  std::array<std::uint8_t, seal::kOldRefusal> out;
  seal::write_old_refusal(datagram, out);
  sink_.send(from, out);
}

void SealServer::send(PeerId to, seal::Bytes plain) {
  const auto found = peers_.find(to);
  if (found == peers_.end()) {
    ++counters_.unsealed;
    return;
  }
  Peer& peer = found->second;
  if (!peer.is_proven) {
    const std::size_t size = plain.size() + seal::kOverhead;
    if (size > peer.may_hear) {
      ++counters_.unproven;
      return;
    }
    peer.may_hear -= size;
  }
  if (!peer.channel->send(plain)) ++counters_.unsealed;
}

void SealServer::end(PeerId peer) {
  const auto found = peers_.find(peer);
  if (found == peers_.end()) return;
  forget_previous(found->second);
  rekeyed_.erase(found->second.channel->id());
  peers_.erase(found);
  if (handlers_.on_end) handlers_.on_end(peer);
}

Address SealServer::address_of(PeerId peer) const {
  const auto found = peers_.find(peer);
  return found == peers_.end() ? Address() : found->second.channel->peer();
}

bool SealServer::is_in_ring(const KeyEntry& key, bool is_invited) const {
  if (is_invited) {
    const KeyEntry* entry = keys_->find_invitation(key.name.view());
    return entry != nullptr && key.invitation && entry->invitation->key == key.invitation->key;
  }
  const KeyEntry* entry = keys_->find(key.name.view());
  return entry != nullptr && entry->kind == key.kind && entry->room == key.room &&
         entry->key == key.key && entry->local_key == key.local_key;
}

void SealServer::set_keys(std::shared_ptr<const KeyRing> keys) {
  keys_ = std::move(keys);
  std::vector<PeerId> gone;
  for (auto& [id, peer] : peers_) {
    if (peer.has_certificate) continue;
    if (!is_in_ring(peer.key, peer.is_invited))
      gone.push_back(id);
    else if (!peer.is_invited)
      peer.key.until_s = keys_->find(peer.key.name.view())->until_s;
  }
  for (const PeerId id : gone) {
    if (handlers_.on_key_removed) handlers_.on_key_removed(id, peers_.at(id).key);
    peers_.at(id).channel->close();
    end(id);
  }
}

MonoTime SealServer::tick(MonoTime now) {
  if (now < next_tick_) return next_tick_;
  const bool do_newcomers_wait = serve_newcomers(now);
  if (do_newcomers_wait && now < next_sweep_) return next_tick_ = now + kTickOfNewcomers;
  if (!secrets_since_.is_set()) secrets_since_ = now;
  if (now - secrets_since_ > kSecretsStand) {
    secrets_[1] = secrets_[0];
    for (std::uint64_t& word : secrets_[0]) word = random_();
    secrets_since_ = now;
  }
  for (std::size_t i = handshakes_.size(); i-- > 0;) {
    // Who hears answers within a round trip, and says it again after a quarter of a second.
    const bool has_answered = handshakes_[i].datagrams > 1;
    const Duration most = has_answered ? limits_.handshake_time : limits_.handshake_time * 2 / 5;
    if (now - handshakes_[i].since > most) {
      reject(SealReject::kTimedOut);
      drop_handshake(i);
    } else {
      handshakes_[i].channel->resend_when_due();
    }
  }
  std::vector<PeerId> silent;
  for (auto& [id, peer] : peers_) {
    if (peer.previous && now > peer.previous_until) forget_previous(peer);
    if (now - peer.last_heard > (peer.is_invited ? limits_.invited_silence : limits_.silence))
      silent.push_back(id);
  }
  for (const PeerId id : silent) end(id);
  next_sweep_ = now + kTickOfHandshakes;
  next_tick_ = do_newcomers_wait      ? now + kTickOfNewcomers
               : !handshakes_.empty() ? next_sweep_
               : !peers_.empty()      ? now + kTickOfPeers
                                      : MonoTime();
  return next_tick_;
}

}  // namespace dance
