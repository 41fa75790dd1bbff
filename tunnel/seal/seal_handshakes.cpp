// How strangers become peers of the server.
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"
#include "tunnel/seal/seal_server.h"

namespace dance {
namespace {

constexpr std::size_t kCookieBytes = 16;
// A handshake has four flights; the rest is what is sent again.
constexpr int kMostDatagrams = 32;
constexpr Duration kMayBeReplaced = Duration::s(5);

// What a link is told in the clear whose key is not the one: that its handshake failed, as it could
// not open anything else. Beside a handshake that goes well nobody can slip this in, as the id is
// known to its two sides only.
constexpr std::array<std::uint8_t, seal::kRecordHeader + 2> kDecryptError{
    seal::kAlert, 0xfe, 0xfd, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0, 2, 2, 51};

}  // namespace

std::size_t SealServer::make_cookie(const SealChannel& channel, std::uint64_t secret_age,
                                    std::uint8_t* out) const {
  std::array<std::uint8_t, 8 + 16 + 2> whom{};
  const std::uint64_t id = channel.id();
  const std::uint16_t port = channel.peer().port();
  std::memcpy(whom.data(), &id, 8);
  std::memcpy(whom.data() + 8, channel.peer().ip().data(), 16);
  std::memcpy(whom.data() + 24, &port, 2);
  std::array<unsigned char, EVP_MAX_MD_SIZE> whole;
  unsigned int size = 0;
  const auto& secret = secrets_[secret_age];
  const auto* made = HMAC(EVP_sha256(), secret.data(), sizeof secret, whom.data(), whom.size(),
                          whole.data(), &size);
  if (made == nullptr || size < kCookieBytes) return 0;
  std::memcpy(out, whole.data(), kCookieBytes);
  return kCookieBytes;
}

bool SealServer::is_cookie(const SealChannel& channel, const std::uint8_t* cookie,
                           std::size_t size) const {
  std::array<std::uint8_t, kCookieBytes> ours;
  for (std::uint64_t age = 0; age < secrets_.size(); ++age)
    if (make_cookie(channel, age, ours.data()) == size &&
        CRYPTO_memcmp(ours.data(), cookie, size) == 0)
      return true;
  return false;
}

std::optional<PresharedKey> SealServer::find_key(ssl_st* ssl, std::string_view identity_text) {
  SealChannel& channel = SealChannel::of(ssl);
  const auto handshake = std::find_if(handshakes_.begin(), handshakes_.end(),
                                      [&](const auto& h) { return h.channel.get() == &channel; });
  if (handshake == handshakes_.end()) return std::nullopt;
  const auto [name, house] = parse_identity(identity_text);
  const bool is_invited = name.starts_with(seal::kInvitedPrefix);
  const KeyEntry* entry = is_invited
                              ? keys_->find_invitation(name.substr(seal::kInvitedPrefix.size()))
                              : keys_->find(name);
  if (entry == nullptr || house.has_value() == entry->is_local()) {
    refuse(channel.peer(), name, SealReject::kUnknownName);
    return house ? server_session_key(identity_, server_key_, *house, nobody_) : std::nullopt;
  }
  if (entry->is_local() && !channel.peer().is_loopback()) {
    refuse(channel.peer(), name, SealReject::kNotLocal);
    return std::nullopt;
  }
  handshake->key = *entry;
  handshake->house = house.value_or(PublicKey());
  handshake->is_known = true;
  handshake->is_invited = is_invited;
  if (entry->is_local()) return entry->local_key;
  return server_session_key(identity_, server_key_, *house,
                            is_invited ? entry->invitation->key : entry->key);
}

void SealServer::on_records(const Address& from, const seal::Opening& opening, MonoTime now) {
  if (const auto session = find_session(opening.id)) {
    if (session->channel->peer() != from) return reject(SealReject::kForeignSource);
    if (!session->channel->take_records(opening.body)) return;
    return session->is_current() ? end(session->id) : forget_previous(*session->peer);
  }
  for (std::size_t i = 0; i < handshakes_.size(); ++i) {
    const SealChannel& channel = *handshakes_[i].channel;
    if (channel.id() == opening.id && channel.peer() == from) return go_on(i, opening.body, now);
  }
  on_stranger(from, opening, now);
}

// A first handshake datagram of an address that has no session here. Without a cookie it is
// answered and forgotten; with one that is ours, it waits for its network's turn.
void SealServer::on_stranger(const Address& from, const seal::Opening& opening, MonoTime now) {
  const auto cookie = seal::cookie_of(opening.body);
  if (!cookie) {
    // Perhaps a record of a session from before this server restarted.
    seal::Bytes rest = opening.body;
    const auto record = seal::take_record(rest);
    if (record && record->epoch > 0) return answer_unknown(from, opening.id, now);
    return reject(SealReject::kMalformed);
  }
  if (!listener_)
    listener_ = std::make_unique<SealChannel>(*context_, SealChannel::Side::kServer, sink_);
  listener_->set_id(opening.id);
  listener_->set_peer(from);
  if (!cookie->empty()) {
    if (!may_newcomer(cookies_, from, now)) return;
    if (is_cookie(*listener_, cookie->data(), cookie->size()))
      return queue_newcomer(from, opening, now);
    reject(SealReject::kBadCookie);
  }
  if (!may_newcomer(strangers_, from, now)) return;
  if (!listener_->listen(opening.body, seal::kIdBytes + opening.body.size()))
    ++counters_.cookies_given;
}

void SealServer::queue_newcomer(const Address& from, const seal::Opening& opening, MonoTime now) {
  switch (newcomers_.push(from, opening.id, opening.body, recent_.contains(from, now), now)) {
    case NewcomerQueue::Pushed::kWaitsAlready:
      return;
    case NewcomerQueue::Pushed::kTooLong:
      return reject(SealReject::kMalformed);
    case NewcomerQueue::Pushed::kOtherDropped:
      reject(SealReject::kCrowdRate);
      break;
    case NewcomerQueue::Pushed::kWaits:
      break;
  }
  // If there is no flood, its turn is now.
  next_tick_ = MonoTime();
  tick(now);
}

// A few at a time: poses are forwarded in between.
bool SealServer::serve_newcomers(MonoTime now) {
  constexpr int kAtOnce = 2;
  for (std::size_t late = newcomers_.drop_late(now); late > 0; --late)
    reject(SealReject::kTimedOut);
  for (int i = 0; i < kAtOnce && newcomers_.size() > 0; ++i) {
    const NewcomerQueue::Newcomer* next = nullptr;
    if (newcomers_.has_known() && begun_known_.take(1.0, now))
      next = newcomers_.pop_known();
    else if (begun_.take(1.0, now))
      next = newcomers_.pop();
    if (next == nullptr) break;
    begin_handshake(*next, now);
  }
  return newcomers_.size() > 0;
}

void SealServer::begin_handshake(const NewcomerQueue::Newcomer& newcomer, MonoTime now) {
  if (!listener_)
    listener_ = std::make_unique<SealChannel>(*context_, SealChannel::Side::kServer, sink_);
  listener_->set_id(newcomer.id);
  listener_->set_peer(newcomer.from);
  if (!listener_->listen(newcomer.records(), seal::kIdBytes + newcomer.size))
    return refuse(newcomer.from, "", SealReject::kNoAgreement);
  make_handshake_place();
  ++counters_.handshakes_begun;
  Handshake handshake;
  handshake.channel = std::move(listener_);
  handshake.since = now;
  handshakes_.push_back(std::move(handshake));
  go_on(handshakes_.size() - 1, {}, now);
}

void SealServer::go_on(std::size_t index, seal::Bytes records, MonoTime now) {
  Handshake& handshake = handshakes_[index];
  SealChannel& channel = *handshake.channel;
  if (++handshake.datagrams > kMostDatagrams) {
    reject(SealReject::kTimedOut);
    return drop_handshake(index);
  }
  switch (channel.handshake(records)) {
    case SealChannel::Progress::kDone:
      return finish(index, now);
    case SealChannel::Progress::kFailed:
      refuse(channel.peer(), handshake.key.name.view(), SealReject::kNoAgreement);
      return drop_handshake(index);
    case SealChannel::Progress::kUnderWay:
      break;
  }
  // All is there for the keys, and what should prove them does not open.
  bool has_proof = false;
  while (const auto record = seal::take_record(records)) has_proof |= record->epoch == 1;
  if (!has_proof || !channel.awaits_proof()) return;
  if (handshake.is_known) refuse(channel.peer(), handshake.key.name.view(), SealReject::kWrongKey);
  std::array<std::uint8_t, seal::kIdBytes + kDecryptError.size()> out;
  seal::write_opening(channel.id(), seal::Form::kRecords, out);
  std::copy(kDecryptError.begin(), kDecryptError.end(), out.begin() + seal::kIdBytes);
  sink_.send(channel.peer(), out);
  drop_handshake(index);
}

void SealServer::finish(std::size_t index, MonoTime now) {
  Handshake& handshake = handshakes_[index];
  // The key may have been taken back while the handshake was under way.
  if (handshake.is_known && !is_in_ring(handshake.key, handshake.is_invited)) {
    refuse(handshake.channel->peer(), handshake.key.name.view(), SealReject::kWrongKey);
    return drop_handshake(index);
  }
  Peer peer;
  peer.key = handshake.key;
  peer.house = handshake.house;
  peer.is_invited = handshake.is_invited;
  if (!handshake.is_known) {  // no key: a certificate
    const std::string common_name = handshake.channel->certificate_name();
    const auto name = GuestId::parse(common_name);
    if (!name) {
      refuse(handshake.channel->peer(), common_name, SealReject::kUnknownName);
      return drop_handshake(index);
    }
    peer.key.name = *name;
    peer.has_certificate = true;
  }
  peer.channel = std::move(handshake.channel);
  peer.proven = peer.channel->peer();
  peer.last_heard = now;
  recent_.note(peer.key.name.view(), peer.proven, now);
  drop_handshake(index);
  const PeerId id = peer.channel->id();
  if (peers_.contains(id) || rekeyed_.contains(id) || !make_place(peer, now))
    return refuse(peer.proven, peer.key.name.view(), SealReject::kFull);
  ++counters_.handshakes_done;
  peers_.emplace(id, std::move(peer));
}

// Makes room for a peer: if its key or the server has no place left, the peer that has been silent
// longest leaves. The key of the server's own machine has no limit of its own.
bool SealServer::make_place(const Peer& comer, MonoTime now) {
  std::size_t of_key = 0;
  const std::pair<const PeerId, Peer>* oldest = nullptr;
  const std::pair<const PeerId, Peer>* oldest_of_key = nullptr;
  for (const auto& entry : peers_) {
    if (oldest == nullptr || entry.second.last_heard < oldest->second.last_heard) oldest = &entry;
    if (entry.second.key.name != comer.key.name || entry.second.is_invited != comer.is_invited)
      continue;
    ++of_key;
    if (oldest_of_key == nullptr || entry.second.last_heard < oldest_of_key->second.last_heard)
      oldest_of_key = &entry;
  }
  const std::size_t most = comer.is_invited                   ? limits_.peers_per_invitation
                           : comer.key.is_local()             ? limits_.peers
                           : comer.key.kind == KeyKind::kRoom ? limits_.peers_per_shared_key
                                                              : limits_.peers_per_key;
  const bool is_key_full = of_key >= most;
  if (!is_key_full && peers_.size() < limits_.peers) return true;
  const auto* goes = is_key_full ? oldest_of_key : oldest;
  if (now - goes->second.last_heard < kMayBeReplaced) return false;
  end(goes->first);
  return true;
}

// Makes room for a handshake: the network that holds most places gives up its oldest one.
void SealServer::make_handshake_place() {
  if (handshakes_.size() < limits_.handshakes) return;
  handshake_networks_.clear();
  for (const Handshake& handshake : handshakes_)  // the oldest first
    handshake_networks_.push_back(NetworkLevels::of(handshake.channel->peer()));
  reject(SealReject::kTimedOut);
  drop_handshake(turns_.oldest_of_most_crowded(handshake_networks_));
}

void SealServer::drop_handshake(std::size_t index) {
  handshakes_.erase(handshakes_.begin() + static_cast<std::ptrdiff_t>(index));
}

}  // namespace dance
