// How a sealed datagram looks from outside: a session id that finds the session whatever address it
// comes from, and behind it either whole DTLS records (handshake, alerts), or one record of
// application data whose header has shrunk to the low half of its sequence number, or nothing (a
// notice that the id is not known). docs/wire-format.md says it byte by byte.
//
// Units/frames: little-endian but for what DTLS says; ids have their two lowest bits clear.
// Ownership:    views of the caller's bytes.
// Threads:      none inside.
// Failure:      parse() gives nullopt for what is no sealed datagram.
// Source:       record header as in RFC 6347, 4.1; replay window as in its 4.1.2.6.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/time.h"

namespace dance::seal {

using Bytes = std::span<const std::uint8_t>;

// Of all that the tunnel says, sealed or not.
constexpr std::uint8_t kTunnelVersion = 4;
constexpr std::size_t kIdBytes = 8;
constexpr std::size_t kRecordHeader = 13;  // type, version, epoch, sequence, length
constexpr std::size_t kTag = 16;           // of ChaCha20-Poly1305
constexpr std::size_t kCompactHeader = kIdBytes + 2;
// What sealing adds to a datagram.
constexpr std::size_t kOverhead = kCompactHeader + kTag;
// Fits the smallest path of IPv6 with the headers of IP and UDP.
constexpr std::size_t kMaxSealed = 1200;
constexpr std::size_t kMaxPlain = kMaxSealed - kOverhead;

constexpr std::uint8_t kAlert = 21;
constexpr std::uint8_t kHandshake = 22;
constexpr std::uint8_t kApplicationData = 23;

enum class Form : std::uint8_t {
  kRecords = 0,  // DTLS records as they are
  kCompact = 1,  // one record of application data: low 16 bits of its sequence, ciphertext, tag
  kNotice = 2,   // the server does not know this id
};

struct Opening {
  std::uint64_t id = 0;
  Form form = Form::kRecords;
  Bytes body;
};
std::optional<Opening> parse(Bytes datagram);
// Writes id and form into the first kIdBytes of out.
void write_opening(std::uint64_t id, Form form, std::span<std::uint8_t> out);
// Makes an id of a random number; 0 where the number does not do (0, or what older versions of the
// tunnel began with).
std::uint64_t id_of(std::uint64_t random);

// One DTLS record where it stands in a datagram.
struct RecordView {
  std::uint8_t type = 0;
  std::uint16_t epoch = 0;
  std::uint64_t sequence = 0;
  Bytes whole;  // header included
  Bytes body() const { return whole.subspan(kRecordHeader); }
};
// Takes the first record off `bytes`; nullopt where there is none.
std::optional<RecordView> take_record(Bytes& bytes);
// The header of a record of application data in epoch 1.
void write_record_header(std::uint64_t sequence, std::size_t body, std::span<std::uint8_t> out);

// The cookie within a ClientHello that stands alone in `records`; empty where it has none, nullopt
// where this is no ClientHello.
std::optional<Bytes> cookie_of(Bytes records);

// What the two ends of the seal tell each other within it: the first byte of a plaintext is one of
// these only there. A server asks a new address whether its peer hears there, and the peer gives
// the eight bytes back.
constexpr std::uint8_t kPathQuestion = 0xf0;
constexpr std::uint8_t kPathAnswer = 0xf1;
constexpr std::size_t kPathBytes = 1 + 8;
// A session that an invitation opened has these two messages only: a link requests that the server
// bind the guest to the identity with which the link opened the session, and the server reports in
// one byte what became of that (Binding).
constexpr std::uint8_t kBindingRequest = 0xf2;
constexpr std::uint8_t kBindingAnswer = 0xf3;
constexpr std::size_t kBindingRequestBytes = 1;
constexpr std::size_t kBindingAnswerBytes = 1 + 1;
// A session gets new keys from a second session beside it. Once that is established, the link sends
// its id and a proof in the first: bytes that only the two ends of the second session can know. The
// server then sends in the second, and begins with one byte.
constexpr std::uint8_t kRekey = 0xf4;
constexpr std::uint8_t kRekeyed = 0xf5;
constexpr std::size_t kSessionProofBytes = 16;
constexpr std::size_t kRekeyBytes = 1 + 8 + kSessionProofBytes;
// How long both ends still accept what was sent in the session before.
constexpr Duration kPreviousSessionStays = Duration::s(5);
// Prefix of the guest's name in the identity of a link that has an invitation: no guest can be
// called so, as a name has no colon.
constexpr std::string_view kInvitedPrefix = "invited:";

// What links said hello with before sessions were sealed, and the answer that they understand: that
// the server speaks a newer version.
constexpr std::size_t kOldRefusal = 17;
bool is_old_hello(Bytes datagram);
void write_old_refusal(Bytes hello, std::span<std::uint8_t, kOldRefusal> out);

// The sequence nearest to `newest` that ends in these bits.
std::uint64_t nearest_sequence(std::uint16_t low, std::uint64_t newest);

// Which of the newest 64 sequence numbers have been taken.
class ReplayWindow {
 public:
  bool may_take(std::uint64_t sequence) const;
  void take(std::uint64_t sequence);
  std::uint64_t newest() const { return newest_; }

 private:
  bool has_any_ = false;
  std::uint64_t newest_ = 0;
  std::uint64_t seen_ = 0;  // bit i: newest − i
};

}  // namespace dance::seal
