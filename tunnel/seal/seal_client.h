// A link's way in to its server: makes the sealed session, keeps it, and makes another beside
// it when the server no longer knows it or is silent. Plaintext in, sealed datagrams out; and back.
//
// Units/frames: MonoTime of this house's clock.
// Ownership:    owns context and sessions; the sink and what the handlers refer to must outlive it.
//               Opening and sealing allocate nothing.
// Threads:      none inside; one owner.
// Failure:      make_…() as SealContext; what is not authentic is counted and dropped; why there is
//               no session is told by on_trouble, again with each try.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/net/datagram_sink.h"
#include "tunnel/seal/seal_channel.h"
#include "tunnel/seal/seal_trouble.h"

namespace dance {

struct SealClientCounters {
  std::uint64_t tries = 0;
  std::uint64_t sessions = 0;
  std::uint64_t rekeyings = 0;  // of a session that stood
  std::uint64_t forged = 0;     // or malformed
  std::uint64_t replayed = 0;
  std::uint64_t notices = 0;   // of a server that does not know our session
  std::uint64_t unsealed = 0;  // had no session to go with
};

// Limits after which a session gets new keys. Each session waits up to a tenth longer, by chance,
// so that the links of a server do not ask at the same time.
struct RekeyLimits {
  Duration age = Duration::s(3600);
  std::uint64_t records = std::uint64_t{1} << 26;  // 78 hours of 240 Hz
};

class SealClient final : public DatagramSink {
 public:
  struct Handlers {
    std::function<void(MonoTime now)> on_sealed;    // a session stands: the first, or another
    std::function<void(MonoTime now)> on_unsealed;  // it has ended, and no other stands
    std::function<void(seal::Bytes plain, MonoTime received, MonoTime now)> on_datagram;
    std::function<void(SealTrouble, MonoTime now)> on_trouble;
  };
  using RandomU64 = std::function<std::uint64_t()>;

  SealClient(std::unique_ptr<SealContext> context, RandomU64 random, Handlers handlers,
             DatagramSink& sink);
  ~SealClient() override;
  SealClient(const SealClient&) = delete;
  SealClient& operator=(const SealClient&) = delete;

  void receive(seal::Bytes datagram, MonoTime received, MonoTime now);
  // Seals and sends in the session that stands; dropped and counted where there is none.
  void send(const Address&, std::span<const std::uint8_t> plain) override;
  // Begins what is due; returns when to call again. The first call begins the first session.
  MonoTime tick(MonoTime now);
  MonoTime next_deadline() const { return next_tick_; }
  // What has been tried so far leads nowhere (the socket is another one): begins at once anew.
  void begin_anew(MonoTime now);
  // The sink leads to another server from now on. That one cannot open the session, so the session
  // ends without a message, and nothing is sent until a session with that server stands.
  void connect_to_other_server(MonoTime now);
  void close();
  // Applies to the session that stands and to those that follow.
  void set_rekey_limits(const RekeyLimits& limits) { rekey_limits_ = limits; }

  bool is_trying() const { return try_.channel != nullptr; }
  bool is_sealed() const { return session_ != nullptr; }
  const SealClientCounters& counters() const { return counters_; }
  // Whether a datagram has ever come that only the server can have sent.
  bool has_heard_server() const { return counters_.sessions > 0; }
  std::string cipher() const { return session_ ? session_->cipher() : ""; }

 private:
  struct Try {
    std::unique_ptr<SealChannel> channel;
    MonoTime since;
    MonoTime heard;
    bool has_heard = false;
    bool is_rekeying = false;  // the session stands, and gets new keys
  };
  // seal_rekey.cpp
  bool is_rekeying_due(MonoTime now) const;
  MonoTime rekey_tick(MonoTime now);
  void announce_next(MonoTime now);
  void switch_to_next(MonoTime now);
  void end_rekeying(MonoTime now);

  SealChannel* channel_of(std::uint64_t id) const;
  void use_session(std::unique_ptr<SealChannel> session, MonoTime now);
  void begin(MonoTime now, bool is_rekeying = false);
  void go_on(seal::Bytes records, MonoTime now);
  void answer_path(seal::Bytes question);
  void give_up(SealTrouble trouble, MonoTime now);

  std::unique_ptr<SealContext> context_;
  RandomU64 random_;
  Handlers handlers_;
  DatagramSink& sink_;
  SealClientCounters counters_;
  std::unique_ptr<SealChannel> session_;
  // Stands beside the session, and is used when the server sends in it.
  std::unique_ptr<SealChannel> next_;
  // Datagrams of the session before the last rekeying are still accepted.
  std::unique_ptr<SealChannel> previous_;
  RekeyLimits rekey_limits_;
  MonoTime session_since_;
  double rekey_delay_ = 0.0;  // share of the age, 0 to 0.1
  MonoTime next_rekeying_;    // not before then
  MonoTime next_since_;
  MonoTime announced_at_;
  MonoTime previous_until_;
  Try try_;
  MonoTime last_heard_;  // in the session
  MonoTime next_try_;
  MonoTime next_tick_;
};

}  // namespace dance
