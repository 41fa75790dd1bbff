// New keys for a session that stands: a second session is made beside it, and both ends go over to
// that one without losing what is under way.
#include <openssl/crypto.h>

#include <cstring>

#include "core/base/deadline.h"
#include "tunnel/seal/seal_client.h"
#include "tunnel/seal/seal_server.h"

namespace dance {
namespace {

constexpr Duration kAnnounceAgain = Duration::ms(250);
// If the server does not switch within this time, the link keeps the old session.
constexpr Duration kGiveUpAfter = Duration::s(10);
constexpr Duration kTryAgainAfter = Duration::s(60);

}  // namespace

bool SealClient::is_rekeying_due(MonoTime now) const {
  if (!session_ || try_.channel || next_ || now < next_rekeying_) return false;
  const Duration age = Duration::seconds(rekey_limits_.age.as_seconds() * (1.0 + rekey_delay_));
  return now - session_since_ >= age || session_->sealed_count() >= rekey_limits_.records;
}

// Does what is due; returns when to call again.
MonoTime SealClient::rekey_tick(MonoTime now) {
  if (previous_ && now > previous_until_) previous_.reset();
  if (next_ && now - next_since_ > kGiveUpAfter) {
    next_->close();
    end_rekeying(now);
  }
  if (next_ && now - announced_at_ >= kAnnounceAgain) announce_next(now);
  if (is_rekeying_due(now)) {
    begin(now, true);
  }
  return next_ ? announced_at_ + kAnnounceAgain : MonoTime();
}

void SealClient::end_rekeying(MonoTime now) {
  try_ = Try();
  next_.reset();
  next_rekeying_ = now + kTryAgainAfter;
}

void SealClient::announce_next(MonoTime now) {
  announced_at_ = now;
  std::array<std::uint8_t, seal::kRekeyBytes> message{seal::kRekey};
  const std::uint64_t id = next_->id();
  const SealChannel::Proof proof = next_->proof();
  std::memcpy(message.data() + 1, &id, sizeof id);
  std::memcpy(message.data() + 1 + sizeof id, proof.data(), proof.size());
  session_->send(message);
}

void SealClient::switch_to_next(MonoTime now) {
  previous_ = std::move(session_);
  previous_until_ = now + seal::kPreviousSessionStays;
  session_ = std::move(next_);
  session_since_ = now;
  ++counters_.rekeyings;
}

std::optional<SealServer::Session> SealServer::find_session(std::uint64_t id_on_wire) {
  const auto rekeyed = rekeyed_.find(id_on_wire);
  const PeerId id = rekeyed != rekeyed_.end() ? rekeyed->second : id_on_wire;
  const auto found = peers_.find(id);
  if (found == peers_.end()) return std::nullopt;
  Peer& peer = found->second;
  if (peer.channel->id() == id_on_wire) return Session{id, &peer, peer.channel.get()};
  if (peer.previous && peer.previous->id() == id_on_wire)
    return Session{id, &peer, peer.previous.get()};
  return std::nullopt;
}

void SealServer::forget_previous(Peer& peer) {
  if (!peer.previous) return;
  rekeyed_.erase(peer.previous->id());
  peer.previous.reset();
}

// The named session must have the same key and the same owner. Other holders of a room's key can
// make sessions too, and ids travel in clear, so the peer proves that it owns the named session.
// Computing the proof is the expensive check, so it comes last.
void SealServer::on_rekey(PeerId id, Peer& peer, seal::Bytes plain, MonoTime now) {
  if (plain.size() != seal::kRekeyBytes) return reject(SealReject::kMalformed);
  std::uint64_t next_id = 0;
  std::memcpy(&next_id, plain.data() + 1, sizeof next_id);
  const std::array<std::uint8_t, 1> answer{seal::kRekeyed};
  if (next_id == peer.channel->id()) return send(id, answer);  // the answer may have been lost
  const auto found = peers_.find(next_id);
  // Its handshake may not be over yet: the link asks again.
  if (found == peers_.end() || next_id == id) return;
  Peer& next = found->second;
  const bool is_same_key = next.key.name == peer.key.name && next.key.key == peer.key.key &&
                           next.key.kind == peer.key.kind && next.key.room == peer.key.room &&
                           next.key.local_key == peer.key.local_key && next.house == peer.house &&
                           next.is_invited == peer.is_invited &&
                           next.has_certificate == peer.has_certificate;
  if (next.channel->id() != next_id || !is_same_key) return reject(SealReject::kForged);
  const SealChannel::Proof proof = next.channel->proof();
  if (CRYPTO_memcmp(proof.data(), plain.data() + 1 + sizeof next_id, proof.size()) != 0)
    return reject(SealReject::kForged);
  forget_previous(peer);
  peer.previous = std::move(peer.channel);
  peer.previous_until = now + seal::kPreviousSessionStays;
  peer.channel = std::move(next.channel);
  // The peer is where the session that stands says: it may have moved since the handshake.
  peer.channel->set_peer(peer.previous->peer());
  forget_previous(next);
  peers_.erase(found);
  rekeyed_.emplace(next_id, id);
  ++counters_.rekeyings;
  // Ends the peer that the new session was until now; what it was used for is lost.
  if (handlers_.on_end) handlers_.on_end(next_id);
  send(id, answer);
}

}  // namespace dance
