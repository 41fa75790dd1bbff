#include "tunnel/seal/seal_channel.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"

namespace dance {

// A BIO of whole datagrams: what is written is one, and what is read is one.
struct SealBio {
  static SealChannel& channel_of(BIO* bio) { return *static_cast<SealChannel*>(BIO_get_data(bio)); }

  static int write(BIO* bio, const char* bytes, int size) {
    BIO_clear_retry_flags(bio);
    return channel_of(bio).on_write(bytes, size);
  }
  static int read(BIO* bio, char* out, int room) {
    BIO_clear_retry_flags(bio);
    const int size = channel_of(bio).on_read(out, room);
    if (size < 0) BIO_set_retry_read(bio);
    return size;
  }
  static long control(BIO*, int command, long, void*) {
    switch (command) {
      case BIO_CTRL_FLUSH:
        return 1;
      case BIO_CTRL_DGRAM_QUERY_MTU:
      case BIO_CTRL_DGRAM_GET_FALLBACK_MTU:
        return static_cast<long>(seal::kMaxSealed - seal::kIdBytes);
      default:
        return 0;
    }
  }
  static int create(BIO* bio) {
    BIO_set_init(bio, 1);
    return 1;
  }
  static BIO_METHOD* method() {
    static BIO_METHOD* const made = [] {
      BIO_METHOD* m = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "dance datagrams");
      DANCE_ASSERT(m != nullptr);
      BIO_meth_set_write(m, write);
      BIO_meth_set_read(m, read);
      BIO_meth_set_ctrl(m, control);
      BIO_meth_set_create(m, create);
      return m;
    }();
    return made;
  }
};

namespace {

// Short at first: a handshake's datagram that is lost costs this, not OpenSSL's second.
unsigned int resend_after_us(SSL*, unsigned int last_us) {
  constexpr unsigned int kFirst_us = 250'000, kLongest_us = 2'000'000;
  return last_us == 0 ? kFirst_us : std::min(2 * last_us, kLongest_us);
}

}  // namespace

SealChannel::SealChannel(const SealContext& context, Side side, DatagramSink& sink)
    : sink_(sink), ssl_(SSL_new(context.get())) {
  DANCE_ASSERT(ssl_ != nullptr);
  BIO* bio = BIO_new(SealBio::method());
  DANCE_ASSERT(bio != nullptr);
  BIO_set_data(bio, this);
  SSL_set_bio(ssl_, bio, bio);  // takes it
  SSL_set_app_data(ssl_, this);
  SSL_set_mtu(ssl_, static_cast<long>(seal::kMaxSealed - seal::kIdBytes));
  DTLS_set_timer_cb(ssl_, resend_after_us);
  if (side == Side::kServer)
    SSL_set_accept_state(ssl_);
  else
    SSL_set_connect_state(ssl_);
}

SealChannel::~SealChannel() { SSL_free(ssl_); }

SealChannel& SealChannel::of(ssl_st* ssl) {
  return *static_cast<SealChannel*>(SSL_get_app_data(ssl));
}

int SealChannel::on_write(const char* bytes, int size) {
  const seal::Bytes record(reinterpret_cast<const std::uint8_t*>(bytes),
                           static_cast<std::size_t>(size));
  seal::Bytes rest = record;
  const auto first = seal::take_record(rest);
  const bool is_compact =
      first && rest.empty() && first->type == seal::kApplicationData && first->epoch == 1;
  const std::size_t body = is_compact ? 2 + first->body().size() : record.size();
  // What is too long is lost, as on the way.
  if (seal::kIdBytes + body > std::min(longest_, out_.size())) return size;
  seal::write_opening(id_, is_compact ? seal::Form::kCompact : seal::Form::kRecords, out_);
  std::uint8_t* out = out_.data() + seal::kIdBytes;
  if (is_compact) {
    *out++ = static_cast<std::uint8_t>(first->sequence);
    *out++ = static_cast<std::uint8_t>(first->sequence >> 8);
    std::memcpy(out, first->body().data(), first->body().size());
  } else {
    std::memcpy(out, record.data(), record.size());
  }
  sink_.send(peer_, {out_.data(), seal::kIdBytes + body});
  return size;
}

int SealChannel::on_read(char* out, int room) {
  if (in_size_ == 0) return -1;
  const std::size_t size = std::min(in_size_, static_cast<std::size_t>(room));
  std::memcpy(out, in_.data(), size);
  in_size_ = 0;
  return static_cast<int>(size);
}

bool SealChannel::listen(seal::Bytes records, std::size_t longest) {
  if (records.size() > in_.size()) return false;
  std::memcpy(in_.data(), records.data(), records.size());
  in_size_ = records.size();
  longest_ = longest;
  ERR_clear_error();
  BIO_ADDR* nobody = BIO_ADDR_new();
  DANCE_ASSERT(nobody != nullptr);
  const int result = DTLSv1_listen(ssl_, nobody);
  BIO_ADDR_free(nobody);
  ERR_clear_error();
  longest_ = seal::kMaxSealed;
  in_size_ = 0;
  return result == 1;
}

SealChannel::Progress SealChannel::handshake(seal::Bytes records) {
  if (records.size() > in_.size()) return Progress::kUnderWay;
  std::copy(records.begin(), records.end(), in_.begin());
  in_size_ = records.size();
  ERR_clear_error();
  const int result = SSL_do_handshake(ssl_);
  in_size_ = 0;
  if (result == 1) {
    is_done_ = true;
    return Progress::kDone;
  }
  const int cause = SSL_get_error(ssl_, result);
  ERR_clear_error();
  return cause == SSL_ERROR_WANT_READ || cause == SSL_ERROR_WANT_WRITE ? Progress::kUnderWay
                                                                       : Progress::kFailed;
}

void SealChannel::resend_when_due() {
  DTLSv1_handle_timeout(ssl_);
  ERR_clear_error();
}

bool SealChannel::awaits_proof() const { return SSL_get_state(ssl_) == TLS_ST_SR_CHANGE; }

bool SealChannel::awaits_answer_to_proof() const {
  const OSSL_HANDSHAKE_STATE state = SSL_get_state(ssl_);
  return state == TLS_ST_CW_FINISHED || state == TLS_ST_CR_SESSION_TICKET ||
         state == TLS_ST_CR_CHANGE;
}

std::string SealChannel::certificate_name() const {
  X509* certificate = SSL_get0_peer_certificate(ssl_);
  if (certificate == nullptr) return "";
  std::array<char, 128> name{};
  const int size = X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName,
                                             name.data(), static_cast<int>(name.size()));
  return size > 0 ? std::string(name.data(), static_cast<std::size_t>(size)) : "";
}

std::string SealChannel::cipher() const { return SSL_get_cipher_name(ssl_); }

SealChannel::Proof SealChannel::proof() const {
  constexpr std::string_view kLabel = "EXPORTER-dance-rekey";
  DANCE_ASSERT(is_done_);
  Proof proof;
  const int made = SSL_export_keying_material(ssl_, proof.data(), proof.size(), kLabel.data(),
                                              kLabel.size(), nullptr, 0, 0);
  DANCE_ASSERT(made == 1, made);
  return proof;
}

SealChannel::Opened SealChannel::open(seal::Bytes body, seal::Bytes& plain) {
  const std::size_t sealed = body.size() - 2;
  // Nothing longer than what we send: OpenSSL would keep the rest for the next.
  if (!is_done_ || sealed > seal::kMaxPlain + seal::kTag) return Opened::kForged;
  const auto low = static_cast<std::uint16_t>(body[0] | body[1] << 8);
  const std::uint64_t sequence = seal::nearest_sequence(low, window_.newest());
  if (!window_.may_take(sequence)) return Opened::kReplayed;
  seal::write_record_header(sequence, sealed, in_);
  std::memcpy(in_.data() + seal::kRecordHeader, body.data() + 2, sealed);
  in_size_ = seal::kRecordHeader + sealed;
  ERR_clear_error();
  const int size = SSL_read(ssl_, plain_.data(), static_cast<int>(plain_.size()));
  in_size_ = 0;
  if (size <= 0) {
    const bool is_closed = SSL_get_error(ssl_, size) != SSL_ERROR_WANT_READ;
    ERR_clear_error();
    return is_closed ? Opened::kClosed : Opened::kForged;
  }
  is_newest_ = sequence >= window_.newest();
  window_.take(sequence);
  plain = {plain_.data(), static_cast<std::size_t>(size)};
  return Opened::kPlain;
}

bool SealChannel::take_records(seal::Bytes records) {
  if (!is_done_) return false;
  in_size_ = 0;
  while (const auto record = seal::take_record(records)) {
    // Of epoch 0 anybody could be the author, and application data has its own form. What is too
    // short to be sealed is an error of ours to OpenSSL, not of its sender.
    if (record->epoch != 1 || record->type == seal::kApplicationData ||
        record->body().size() <= seal::kTag)
      continue;
    if (in_size_ + record->whole.size() > in_.size()) break;
    std::memcpy(in_.data() + in_size_, record->whole.data(), record->whole.size());
    in_size_ += record->whole.size();
  }
  if (in_size_ == 0) return false;
  ERR_clear_error();
  const int size = SSL_read(ssl_, plain_.data(), static_cast<int>(plain_.size()));
  in_size_ = 0;
  const bool is_closed = size <= 0 && SSL_get_error(ssl_, size) != SSL_ERROR_WANT_READ;
  ERR_clear_error();
  return is_closed;
}

bool SealChannel::send(seal::Bytes plain) {
  if (!is_done_ || plain.empty() || plain.size() > seal::kMaxPlain) return false;
  ERR_clear_error();
  const int size = SSL_write(ssl_, plain.data(), static_cast<int>(plain.size()));
  if (size > 0) {
    ++sealed_count_;
    return true;
  }
  ERR_clear_error();
  return false;
}

void SealChannel::close() {
  if (!is_done_) return;
  SSL_shutdown(ssl_);
  ERR_clear_error();
  is_done_ = false;
}

}  // namespace dance
