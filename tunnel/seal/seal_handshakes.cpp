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

std::optional<PresharedKey> SealServer::find_key(ssl_st* ssl, std::string_view identity) {
  SealChannel& channel = SealChannel::of(ssl);
  const auto handshake = std::find_if(handshakes_.begin(), handshakes_.end(),
                                      [&](const auto& h) { return h.channel.get() == &channel; });
  if (handshake == handshakes_.end()) return std::nullopt;
  const bool is_invited = identity.starts_with(seal::kInvitedPrefix);
  const KeyEntry* entry = is_invited
                              ? keys_->find_invitation(identity.substr(seal::kInvitedPrefix.size()))
                              : keys_->find(identity);
  if (entry == nullptr) {
    reject(SealReject::kUnknownName);
    return std::nullopt;
  }
  if (entry->is_local && !channel.peer().is_loopback()) {
    reject(SealReject::kNotLocal);
    return std::nullopt;
  }
  handshake->key = *entry;
  handshake->is_known = true;
  handshake->is_invited = is_invited;
  return is_invited ? entry->invitation->key : entry->key;
}

void SealServer::on_records(const Address& from, const seal::Opening& opening, MonoTime now) {
  if (const auto found = peers_.find(opening.id); found != peers_.end()) {
    SealChannel& channel = *found->second.channel;
    if (channel.peer() != from) return reject(SealReject::kForeignSource);
    if (channel.take_records(opening.body)) end(opening.id);
    return;
  }
  for (std::size_t i = 0; i < handshakes_.size(); ++i) {
    const SealChannel& channel = *handshakes_[i].channel;
    if (channel.id() == opening.id && channel.peer() == from) return go_on(i, opening.body, now);
  }
  on_stranger(from, opening, now);
}

void SealServer::on_stranger(const Address& from, const seal::Opening& opening, MonoTime now) {
  const auto cookie = seal::cookie_of(opening.body);
  if (!cookie) {
    // Perhaps of a session before the server began anew.
    seal::Bytes rest = opening.body;
    const auto record = seal::take_record(rest);
    if (record && record->epoch > 0) return answer_unknown(from, opening.id, now);
    return reject(SealReject::kMalformed);
  }
  if (!listener_)
    listener_ = std::make_unique<SealChannel>(*context_, SealChannel::Side::kServer, sink_);
  listener_->set_id(opening.id);
  listener_->set_peer(from);
  if (!cookie->empty() && !may(cookies_, from, now)) return;
  const bool is_proven = !cookie->empty() && is_cookie(*listener_, cookie->data(), cookie->size());
  if (!cookie->empty() && !is_proven) reject(SealReject::kBadCookie);
  if (!may(is_proven ? begun_ : strangers_, from, now)) return;
  if (is_proven && !make_handshake_place(from)) return reject(SealReject::kFull);
  if (!listener_->listen(opening.body, seal::kIdBytes + opening.body.size())) {
    if (is_proven)
      reject(SealReject::kNoAgreement);
    else
      ++counters_.cookies_given;
    return;
  }
  ++counters_.handshakes_begun;
  Handshake handshake;
  handshake.channel = std::move(listener_);
  handshake.since = now;
  handshakes_.push_back(std::move(handshake));
  next_tick_ = MonoTime();
  go_on(handshakes_.size() - 1, {}, now);
  tick(now);
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
      reject(SealReject::kNoAgreement);
      return drop_handshake(index);
    case SealChannel::Progress::kUnderWay:
      break;
  }
  // All is there for the keys, and what should prove them does not open.
  bool has_proof = false;
  while (const auto record = seal::take_record(records)) has_proof |= record->epoch == 1;
  if (!has_proof || !channel.awaits_proof()) return;
  if (handshake.is_known) reject(SealReject::kWrongKey);
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
    reject(SealReject::kWrongKey);
    return drop_handshake(index);
  }
  Peer peer;
  peer.key = handshake.key;
  peer.is_invited = handshake.is_invited;
  if (!handshake.is_known) {  // no key: a certificate
    const auto name = GuestId::parse(handshake.channel->certificate_name());
    if (!name) {
      reject(SealReject::kUnknownName);
      return drop_handshake(index);
    }
    peer.key.name = *name;
    peer.has_certificate = true;
  }
  peer.channel = std::move(handshake.channel);
  peer.proven = peer.channel->peer();
  peer.last_heard = now;
  drop_handshake(index);
  const PeerId id = peer.channel->id();
  if (peers_.contains(id) || !make_place(peer, now)) return reject(SealReject::kFull);
  ++counters_.handshakes_done;
  peers_.emplace(id, std::move(peer));
}

// Where there is no place left, for this key or for anybody, who has been silent longest makes it.
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
  const std::size_t most = comer.is_invited ? limits_.peers_per_invitation : limits_.peers_per_key;
  const bool is_key_full = of_key >= most;
  if (!is_key_full && peers_.size() < limits_.peers) return true;
  const auto* goes = is_key_full ? oldest_of_key : oldest;
  if (now - goes->second.last_heard < kMayBeReplaced) return false;
  end(goes->first);
  return true;
}

// One network has so many under way and no more; where all places are taken, the oldest of the
// network that has most makes room.
bool SealServer::make_handshake_place(const Address& from) {
  const auto of = [this](const Address& address) {
    return std::count_if(handshakes_.begin(), handshakes_.end(), [&](const Handshake& h) {
      return h.channel->peer().network() == address.network();
    });
  };
  if (static_cast<std::size_t>(of(from)) >= limits_.handshakes_per_network) return false;
  if (handshakes_.size() < limits_.handshakes) return true;
  std::size_t goes = 0;
  std::ptrdiff_t most = 0;
  for (std::size_t i = 0; i < handshakes_.size(); ++i) {  // the oldest first
    const auto count = of(handshakes_[i].channel->peer());
    if (count <= most) continue;
    most = count;
    goes = i;
  }
  reject(SealReject::kTimedOut);
  drop_handshake(goes);
  return true;
}

void SealServer::drop_handshake(std::size_t index) {
  handshakes_.erase(handshakes_.begin() + static_cast<std::ptrdiff_t>(index));
}

}  // namespace dance
