// The sealed side of a server: turns datagrams from the internet into plaintext of peers who have
// proved their identity, and back. A peer that has proved nothing costs a bounded, small
// amount of work, is kept nowhere, and is never answered with more bytes than it sent.
//
// Units/frames: MonoTime of the server's clock; a peer is named by the id of its first session, and
//               keeps the name when it gets new keys.
// Ownership:    owns all sealed sessions; keys are shared and replaced whole; the sink and what the
//               handlers refer to must outlive it. Opening and sealing allocate nothing.
// Threads:      none inside; one owner.
// Failure:      whatever is not right is counted by cause and changes nothing; nothing from outside
//               can make it stop or grow.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/base/token_bucket.h"
#include "core/net/datagram_sink.h"
#include "tunnel/seal/keys/key_ring.h"
#include "tunnel/seal/newcomer_queue.h"
#include "tunnel/seal/recent_networks.h"
#include "tunnel/seal/seal_channel.h"
#include "tunnel/seal/source_limits.h"

namespace dance {

struct SealLimits {
  std::size_t peers = 512;
  // Handshakes in progress. When all places are taken, the network that holds most of them gives
  // one up.
  std::size_t handshakes = 256;
  // Newcomers that wait until their handshake begins.
  std::size_t newcomers = 512;
  Duration handshake_time = Duration::s(5);
  // A peer that is silent this long needs a new handshake; until then it returns in one round trip.
  Duration silence = Duration::s(60);
  // First datagrams of strangers, which are answered and forgotten.
  SourceLimits::Rates strangers{100.0, 200.0, 10'000.0, 2000.0};
  // Checks of cookies, which cost a little too.
  SourceLimits::Rates cookies{200.0, 400.0, 20'000.0, 4000.0};
  // Peers at a time with one person's key, and with a key that a whole room shares.
  std::size_t peers_per_key = 16;
  std::size_t peers_per_shared_key = 256;
  // With one invitation, and how long one may be silent: such a session has little to say.
  std::size_t peers_per_invitation = 4;
  Duration invited_silence = Duration::s(10);
  // Answers to datagrams of a session that has ended.
  SourceLimits::Rates notices{50.0, 200.0, 2000.0, 1000.0};
  // New handshakes a second, given to networks in turns; and as many again for networks from which
  // a key was used lately.
  double handshakes_per_second = 400.0;
  double handshake_burst = 400.0;
};

enum class SealReject : std::uint8_t {
  kTooShort,       // nothing of ours
  kOldVersion,     // a link from before sealed sessions
  kMalformed,      // no handshake, or no record
  kUnknownId,      // a session that this server does not have
  kStrangerRate,   // one network asks too often
  kCrowdRate,      // all together do
  kBadCookie,      // an old one, or of another address
  kFull,           // too many handshakes or peers
  kTimedOut,       // a handshake that was not ended
  kUnknownName,    // no key of this name
  kWrongKey,       // not the key of this name
  kNotLocal,       // the key of this machine, from elsewhere
  kNoAgreement,    // no common version, cipher or trust
  kForged,         // a record that is not authentic
  kReplayed,       // a record that came before
  kForeignSource,  // handshake of a session from another address
  kControlRate,    // a peer sends too many requests for new keys or for a binding
  kCount,
};
constexpr std::size_t kSealRejects = static_cast<std::size_t>(SealReject::kCount);
constexpr std::array<std::string_view, kSealRejects> kSealRejectNames{
    "too_short",    "old_version", "malformed", "unknown_id",     "stranger_rate", "crowd_rate",
    "bad_cookie",   "full",        "timed_out", "unknown_name",   "wrong_key",     "not_local",
    "no_agreement", "forged",      "replayed",  "foreign_source", "control_rate"};

struct SealCounters {
  std::uint64_t datagrams_in = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t datagrams_out = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t cookies_given = 0;
  std::uint64_t handshakes_begun = 0;
  std::uint64_t handshakes_done = 0;
  std::uint64_t rekeyings = 0;  // of a session that stood
  std::uint64_t moves = 0;      // of a session to another address
  std::uint64_t unproven = 0;   // not sent to an address that has not answered yet
  std::uint64_t unsealed = 0;   // the peer is gone, or the datagram too long
  std::array<std::uint64_t, kSealRejects> rejected{};
  std::uint64_t of(SealReject cause) const { return rejected[static_cast<std::size_t>(cause)]; }
};

class SealServer {
 public:
  using PeerId = std::uint64_t;
  struct Handlers {
    std::function<void(PeerId, const KeyEntry&, seal::Bytes plain, MonoTime received, MonoTime now)>
        on_datagram;
    // A house that opened its session with an invitation asks to be the invited guest: until
    // answer_binding() it asks again.
    std::function<void(PeerId, const KeyEntry&, const PublicKey& house)> on_binding;
    std::function<void(PeerId)> on_end;  // the peer is gone: it closed, was silent, or lost its key
    // The handshake of a peer that receives at `from` was refused. `name` is the peer's own:
    // untrusted bytes, empty if it gave none.
    std::function<void(const Address& from, std::string_view name, SealReject cause)> on_refused;
    // The key of this peer was removed or replaced; on_end follows.
    std::function<void(PeerId, const KeyEntry&)> on_key_removed;
  };
  using RandomU64 = std::function<std::uint64_t()>;

  static Result<std::unique_ptr<SealServer>> make(
      const SealLimits& limits, const PrivateKey& identity, std::shared_ptr<const KeyRing> keys,
      const std::optional<SealCertificates>& certificates, RandomU64 random, Handlers handlers,
      DatagramSink& sink);
  ~SealServer();
  SealServer(const SealServer&) = delete;
  SealServer& operator=(const SealServer&) = delete;

  void receive(const Address& from, seal::Bytes datagram, MonoTime received, MonoTime now);
  void send(PeerId to, seal::Bytes plain);
  void answer_binding(PeerId to, Binding binding);
  // Ends handshakes and peers that are overdue; returns when to call again, MonoTime() = not before
  // a datagram.
  MonoTime tick(MonoTime now);
  MonoTime next_deadline() const { return next_tick_; }
  // Replaces all keys; drops the peers whose key is gone.
  void set_keys(std::shared_ptr<const KeyRing> keys);

  const KeyRing& keys() const { return *keys_; }
  const SealCounters& counters() const { return counters_; }
  std::size_t peer_count() const { return peers_.size(); }
  std::size_t handshake_count() const { return handshakes_.size(); }
  // The address of a peer; not set if there is none.
  Address address_of(PeerId peer) const;

 private:
  struct Peer {
    std::unique_ptr<SealChannel> channel;
    // The session before the last rekeying: its late datagrams are accepted for a while.
    std::unique_ptr<SealChannel> previous;
    MonoTime previous_until;
    KeyEntry key;
    PublicKey house;  // that it has proved; not set: a certificate, or a program of this machine
    bool has_certificate = false;
    bool is_invited = false;  // came with the invitation of that entry
    MonoTime last_heard;
    // A new address of the peer gets few bytes until it has answered.
    Address proven;
    bool is_proven = true;
    std::uint64_t question = 0;
    MonoTime asked_at;
    std::size_t may_hear = 0;  // bytes, until then
    // Requests to the seal itself. Each may cost a key derivation or a file write, and no limit of
    // the rooms applies to it. A link sends at most four a second.
    TokenBucket control{8.0, 8.0};
  };
  struct Handshake {
    std::unique_ptr<SealChannel> channel;
    KeyEntry key;  // of the name that the other side gives; not set before
    PublicKey house;
    bool is_known = false;
    bool is_invited = false;
    MonoTime since;
    int datagrams = 0;
  };
  // All that leaves is counted.
  class CountingSink final : public DatagramSink {
   public:
    CountingSink(DatagramSink& sink, SealCounters& counters) : sink_(sink), counters_(counters) {}
    void send(const Address& to, std::span<const std::uint8_t> bytes) override;

   private:
    DatagramSink& sink_;
    SealCounters& counters_;
  };

  SealServer(const SealLimits& limits, const PrivateKey& identity,
             std::shared_ptr<const KeyRing> keys, RandomU64 random, Handlers handlers,
             DatagramSink& sink);
  void reject(SealReject cause) { ++counters_.rejected[static_cast<std::size_t>(cause)]; }
  bool may(SourceLimits& limits, const Address& from, MonoTime now);
  // Like may(), but networks that used a key lately have a rate of their own.
  bool may_newcomer(SourceLimits& limits, const Address& from, MonoTime now);
  // Counts a refused handshake and reports it. Only for addresses that have returned a cookie: the
  // source of anything else may be forged.
  void refuse(const Address& from, std::string_view name, SealReject cause);

  // seal_server.cpp
  void on_compact(const Address& from, const seal::Opening& opening, MonoTime received,
                  MonoTime now);
  void on_old_version(const Address& from, seal::Bytes datagram, MonoTime now);
  void answer_unknown(const Address& from, std::uint64_t id, MonoTime now);
  bool on_moved(Peer& peer, const Address& from);
  void ask_path(PeerId id, Peer& peer, std::size_t heard, MonoTime now);
  bool is_path_answer(Peer& peer, const Address& from, seal::Bytes plain);
  void end(PeerId peer);
  void on_invited(PeerId id, const Peer& peer, seal::Bytes plain);
  bool is_in_ring(const KeyEntry& key, bool is_invited) const;

  // seal_rekey.cpp
  struct Session {
    PeerId id = 0;
    Peer* peer = nullptr;
    SealChannel* channel = nullptr;  // the peer's, or its previous one
    bool is_current() const { return channel == peer->channel.get(); }
  };
  std::optional<Session> find_session(std::uint64_t id_on_wire);
  void on_rekey(PeerId id, Peer& peer, seal::Bytes plain, MonoTime now);
  void forget_previous(Peer& peer);

  // seal_handshakes.cpp
  void on_records(const Address& from, const seal::Opening& opening, MonoTime now);
  void on_stranger(const Address& from, const seal::Opening& opening, MonoTime now);
  void go_on(std::size_t handshake, seal::Bytes records, MonoTime now);
  void finish(std::size_t handshake, MonoTime now);
  void drop_handshake(std::size_t handshake);
  bool make_place(const Peer& comer, MonoTime now);
  void queue_newcomer(const Address& from, const seal::Opening& opening, MonoTime now);
  // Begins the handshakes whose turn it is; true where more wait.
  bool serve_newcomers(MonoTime now);
  void begin_handshake(const NewcomerQueue::Newcomer& newcomer, MonoTime now);
  void make_handshake_place();
  std::optional<PresharedKey> find_key(ssl_st* ssl, std::string_view identity_text);
  std::size_t make_cookie(const SealChannel& channel, std::uint64_t secret_age,
                          std::uint8_t* out) const;
  bool is_cookie(const SealChannel& channel, const std::uint8_t* cookie, std::size_t size) const;

  SealLimits limits_;
  PrivateKey identity_;
  PublicKey server_key_;
  // Stands in for the key of an unknown name, which then takes as long as another.
  PublicKey nobody_;
  std::shared_ptr<const KeyRing> keys_;
  RandomU64 random_;
  Handlers handlers_;
  SealCounters counters_;
  CountingSink sink_;
  std::unique_ptr<SealContext> context_;
  std::unordered_map<PeerId, Peer> peers_;
  // Ids on the wire of sessions that are not their peer's first.
  std::unordered_map<std::uint64_t, PeerId> rekeyed_;
  std::vector<Handshake> handshakes_;
  std::unique_ptr<SealChannel> listener_;  // for the next client
  SourceLimits strangers_;
  SourceLimits notices_;
  SourceLimits cookies_;
  NewcomerQueue newcomers_;
  NetworkTurns turns_;
  std::vector<NetworkLevels> handshake_networks_;  // scratch of make_handshake_place()
  RecentNetworks recent_;
  TokenBucket begun_, begun_known_;
  TokenBucket known_datagrams_;  // first datagrams of known networks during a flood
  // Cookies are made with the first; those of the second are still good.
  std::array<std::array<std::uint64_t, 4>, 2> secrets_;
  MonoTime secrets_since_;
  MonoTime next_sweep_;  // of handshakes and peers
  MonoTime next_tick_;
};

}  // namespace dance
