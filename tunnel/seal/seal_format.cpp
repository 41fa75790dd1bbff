#include "tunnel/seal/seal_format.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"

namespace dance::seal {
namespace {

constexpr std::uint64_t kFormBits = 3;
constexpr std::uint64_t kSequenceMask = (std::uint64_t{1} << 48) - 1;
// The low half of what versions 1 and 2 of the tunnel began with: "DCGR".
constexpr std::uint32_t kOldMagic = 0x52474344;

std::uint64_t big_endian(Bytes bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

}  // namespace

std::optional<Opening> parse(Bytes datagram) {
  if (datagram.size() < kIdBytes) return std::nullopt;
  std::uint64_t id = 0;
  for (std::size_t i = kIdBytes; i-- > 0;) id = id << 8 | datagram[i];
  const auto form = static_cast<std::uint8_t>(id & kFormBits);
  if (form > static_cast<std::uint8_t>(Form::kNotice)) return std::nullopt;
  id &= ~kFormBits;
  if (id == 0) return std::nullopt;
  const Opening opening{id, static_cast<Form>(form), datagram.subspan(kIdBytes)};
  if (opening.form == Form::kNotice && !opening.body.empty()) return std::nullopt;
  if (opening.form == Form::kCompact && opening.body.size() < 2 + kTag) return std::nullopt;
  if (opening.form == Form::kRecords && opening.body.size() < kRecordHeader) return std::nullopt;
  return opening;
}

void write_opening(std::uint64_t id, Form form, std::span<std::uint8_t> out) {
  DANCE_ASSERT(out.size() >= kIdBytes && (id & kFormBits) == 0);
  const std::uint64_t word = id | static_cast<std::uint8_t>(form);
  for (std::size_t i = 0; i < kIdBytes; ++i) out[i] = static_cast<std::uint8_t>(word >> (8 * i));
}

std::uint64_t id_of(std::uint64_t random) {
  const std::uint64_t id = random & ~kFormBits;
  return static_cast<std::uint32_t>(id) == (kOldMagic & ~kFormBits) ? 0 : id;
}

std::optional<RecordView> take_record(Bytes& bytes) {
  if (bytes.size() < kRecordHeader) return std::nullopt;
  const auto length = static_cast<std::size_t>(big_endian(bytes.subspan(11, 2)));
  if (bytes.size() < kRecordHeader + length) return std::nullopt;
  RecordView record;
  record.type = bytes[0];
  record.epoch = static_cast<std::uint16_t>(big_endian(bytes.subspan(3, 2)));
  record.sequence = big_endian(bytes.subspan(5, 6));
  record.whole = bytes.first(kRecordHeader + length);
  bytes = bytes.subspan(kRecordHeader + length);
  return record;
}

void write_record_header(std::uint64_t sequence, std::size_t body, std::span<std::uint8_t> out) {
  DANCE_ASSERT(out.size() >= kRecordHeader && body <= UINT16_MAX);
  out[0] = kApplicationData;
  out[1] = 0xfe;  // DTLS 1.2
  out[2] = 0xfd;
  out[3] = 0;  // epoch 1
  out[4] = 1;
  for (std::size_t i = 0; i < 6; ++i)
    out[5 + i] = static_cast<std::uint8_t>(sequence >> (8 * (5 - i)));
  out[11] = static_cast<std::uint8_t>(body >> 8);
  out[12] = static_cast<std::uint8_t>(body);
}

std::optional<Bytes> cookie_of(Bytes records) {
  const auto record = take_record(records);
  if (!record || !records.empty()) return std::nullopt;
  if (record->type != kHandshake || record->epoch != 0) return std::nullopt;
  // Handshake header: type, length, number, offset and length of the fragment.
  constexpr std::size_t kMessageHeader = 12, kVersionAndRandom = 34;
  Bytes rest = record->body();
  constexpr std::uint8_t kClientHello = 1;
  if (rest.size() < kMessageHeader + kVersionAndRandom + 1 || rest[0] != kClientHello)
    return std::nullopt;
  rest = rest.subspan(kMessageHeader + kVersionAndRandom);
  const std::size_t session = rest[0];
  if (rest.size() < 1 + session + 1) return std::nullopt;
  rest = rest.subspan(1 + session);
  const std::size_t cookie = rest[0];
  if (rest.size() < 1 + cookie) return std::nullopt;
  return rest.subspan(1, cookie);
}

bool is_old_hello(Bytes datagram) {
  // Magic, version, type 1 (hello), 0, nonce.
  return datagram.size() >= kOldRefusal && datagram[0] == 0x44 && datagram[1] == 0x43 &&
         datagram[2] == 0x47 && datagram[3] == 0x52 && datagram[4] < kTunnelVersion &&
         datagram[5] == 1;
}

void write_old_refusal(Bytes hello, std::span<std::uint8_t, kOldRefusal> out) {
  constexpr std::uint8_t kRefusal = 3, kVersionIsUnknown = 1;
  const std::array<std::uint8_t, 8> head{
      0x44, 0x43, 0x47, 0x52, kTunnelVersion, kRefusal, kVersionIsUnknown, 0};
  std::copy(head.begin(), head.end(), out.begin());
  const Bytes nonce = hello.subspan(8, 8);
  std::copy(nonce.begin(), nonce.end(), out.begin() + 8);
  out[16] = 0;  // it is about no guest
}

std::uint64_t nearest_sequence(std::uint16_t low, std::uint64_t newest) {
  const auto ahead = static_cast<std::int16_t>(
      static_cast<std::uint16_t>(low - static_cast<std::uint16_t>(newest)));
  // Before the first there is nothing: the bits are then of what lies ahead.
  if (ahead < 0 && newest < static_cast<std::uint64_t>(-std::int64_t{ahead}))
    return (newest + static_cast<std::uint64_t>(std::int64_t{ahead} + 0x10000)) & kSequenceMask;
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(newest) + ahead) & kSequenceMask;
}

bool ReplayWindow::may_take(std::uint64_t sequence) const {
  if (!has_any_ || sequence > newest_) return true;
  const std::uint64_t back = newest_ - sequence;
  return back < 64 && (seen_ >> back & 1) == 0;
}

void ReplayWindow::take(std::uint64_t sequence) {
  if (!has_any_ || sequence > newest_) {
    const std::uint64_t ahead = has_any_ ? sequence - newest_ : 64;
    seen_ = ahead < 64 ? seen_ << ahead : 0;
    newest_ = sequence;
    has_any_ = true;
  }
  seen_ |= std::uint64_t{1} << (newest_ - sequence);
}

}  // namespace dance::seal
