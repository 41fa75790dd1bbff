// One sealed session, from its first handshake datagram to its end: datagrams in, plaintext out,
// and back. What OpenSSL wants to send goes to the sink, framed with the session's id.
//
// Units/frames: whole datagrams as in tunnel/seal/seal_format.h; plaintexts of at most kMaxPlain.
// Ownership:    owns the OpenSSL object and its buffers; the context and the sink must outlive it.
//               Sealing and opening allocate nothing.
// Threads:      none inside; one owner.
// Failure:      open() gives nullopt for what is not authentic or comes twice; handshake() tells
//               how it ended.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "core/base/time.h"
#include "core/net/datagram_sink.h"
#include "tunnel/seal/seal_context.h"
#include "tunnel/seal/seal_format.h"

struct bio_st;

namespace dance {

class SealChannel {
 public:
  enum class Side : std::uint8_t { kServer, kLink };
  enum class Progress : std::uint8_t { kUnderWay, kDone, kFailed };
  enum class Opened : std::uint8_t { kPlain, kReplayed, kForged, kClosed };

  SealChannel(const SealContext& context, Side side, DatagramSink& sink);
  ~SealChannel();
  SealChannel(const SealChannel&) = delete;
  SealChannel& operator=(const SealChannel&) = delete;

  void set_id(std::uint64_t id) { id_ = id; }
  std::uint64_t id() const { return id_; }
  void set_peer(const Address& peer) { peer_ = peer; }
  const Address& peer() const { return peer_; }
  // What the owner's callbacks of the context find this channel by.
  static SealChannel& of(ssl_st* ssl);

  // A server's answer to a ClientHello of somebody who has proved nothing. True where the cookie in
  // it was ours: handshake() goes on with it then. Nothing longer than `longest` is sent.
  bool listen(seal::Bytes records, std::size_t longest);
  // Takes a step, with `records` of the other side or with nothing.
  Progress handshake(seal::Bytes records);
  // Sends again what may be lost, when it is time.
  void resend_when_due();
  // The server has all it needs for the keys but for the proof that the other side has the same.
  bool awaits_proof() const;
  // The same moment, as the link sees it.
  bool awaits_answer_to_proof() const;
  // Name in the certificate of the other side ("" = it showed none), once done.
  std::string certificate_name() const;
  std::string cipher() const;
  using Proof = std::array<std::uint8_t, seal::kSessionProofBytes>;
  // Bytes that only the two ends of this session can know, once done (RFC 5705).
  Proof proof() const;
  // Records sealed so far.
  std::uint64_t sealed_count() const { return sealed_count_; }

  // Once done: one compact datagram's body to plaintext, valid until the next call.
  Opened open(seal::Bytes body, seal::Bytes& plain);
  // Whether the record last opened is newer than all before.
  bool is_newest() const { return is_newest_; }
  // Once done: records in the long form, of which only those of the session count: the handshake's
  // last flight again, or the end. True when the other side has closed it.
  bool take_records(seal::Bytes records);
  // Seals and sends; false where there is no session or the plaintext is too long.
  bool send(seal::Bytes plain);
  // Tells the other side that it ends.
  void close();

 private:
  friend struct SealBio;  // OpenSSL's way to its datagrams
  int on_write(const char* bytes, int size);
  int on_read(char* out, int room);

  DatagramSink& sink_;
  std::uint64_t id_ = 0;
  Address peer_;
  ssl_st* ssl_ = nullptr;
  bool is_done_ = false;
  bool is_newest_ = false;
  std::size_t longest_ = seal::kMaxSealed;
  std::uint64_t sealed_count_ = 0;
  seal::ReplayWindow window_;
  // The one datagram that OpenSSL reads next.
  std::array<std::uint8_t, seal::kRecordHeader + 2048> in_;
  std::size_t in_size_ = 0;
  std::array<std::uint8_t, seal::kMaxSealed> plain_;
  std::array<std::uint8_t, seal::kMaxSealed> out_;
};

}  // namespace dance
