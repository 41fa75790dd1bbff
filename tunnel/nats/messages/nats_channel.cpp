#include "tunnel/nats/messages/nats_channel.h"

#include <openssl/err.h>
#include <openssl/x509v3.h>

#include "core/base/printable.h"

namespace dance {
namespace {

struct ContextDeleter {
  void operator()(SSL_CTX* it) const { SSL_CTX_free(it); }
};

std::string tls_reason(const SSL* tls) {
  if (tls != nullptr)
    if (const long verified = SSL_get_verify_result(tls); verified != X509_V_OK)
      return X509_verify_cert_error_string(verified);
  const char* text = ERR_reason_error_string(ERR_peek_last_error());
  return text != nullptr ? printable(text) : "the connection ended";
}

Result<void> use_papers(SSL_CTX* context, const NatsOptions& options) {
  const bool trusts = options.authorities.empty()
                          ? SSL_CTX_set_default_verify_paths(context) == 1
                          : SSL_CTX_load_verify_file(context, options.authorities.c_str()) == 1;
  if (!trusts)
    return fail("--cluster-authorities " + printable(options.authorities) + ": " +
                tls_reason(nullptr));
  if (options.certificate.empty()) return {};
  if (SSL_CTX_use_certificate_chain_file(context, options.certificate.c_str()) != 1 ||
      SSL_CTX_use_PrivateKey_file(context, options.private_key.c_str(), SSL_FILETYPE_PEM) != 1)
    return fail("--cluster-certificate " + printable(options.certificate) + ": " +
                tls_reason(nullptr));
  return {};
}

bool expect_host(SSL* tls, const std::string& host) {
  if (X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(tls), host.c_str()) == 1) return true;
  return SSL_set1_host(tls, host.c_str()) == 1 && SSL_set_tlsext_host_name(tls, host.c_str()) == 1;
}

}  // namespace

Result<void> NatsChannel::start_tls(const NatsOptions& options, const std::string& host,
                                    const NatsDeadline& deadline) {
  ERR_clear_error();
  const std::unique_ptr<SSL_CTX, ContextDeleter> context(SSL_CTX_new(TLS_client_method()));
  if (!context) return fail("TLS: no memory");
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_mode(context.get(),
                   SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  if (auto used = use_papers(context.get(), options); !used) return used;
  tls_.reset(SSL_new(context.get()));
  if (!tls_ || SSL_set_fd(tls_.get(), socket_.fd()) != 1 || !expect_host(tls_.get(), host))
    return fail("TLS: no memory");
  for (;;) {
    const int done = SSL_connect(tls_.get());
    if (done == 1) return {};
    const int error = SSL_get_error(tls_.get(), done);
    const bool reads = error == SSL_ERROR_WANT_READ;
    if (!reads && error != SSL_ERROR_WANT_WRITE) return fail("no TLS: " + tls_reason(tls_.get()));
    if (deadline.is_over()) return fail("no TLS: the server does not answer");
    if (reads)
      socket_.wait_for_bytes(deadline.slice());
    else
      socket_.wait_for_room(deadline.slice());
  }
}

std::optional<std::size_t> NatsChannel::read(std::span<std::uint8_t> into) {
  if (!tls_) return socket_.read(into);
  std::size_t in_all = 0;
  while (in_all < into.size()) {
    ERR_clear_error();
    std::size_t count = 0;
    const int done = SSL_read_ex(tls_.get(), into.data() + in_all, into.size() - in_all, &count);
    in_all += count;
    if (done == 1) continue;
    if (SSL_get_error(tls_.get(), done) == SSL_ERROR_WANT_READ) break;
    if (in_all > 0) break;  // the end comes again
    return std::nullopt;
  }
  return in_all;
}

std::optional<std::size_t> NatsChannel::write(std::span<const std::uint8_t> from) {
  if (!tls_) return socket_.write(from);
  std::size_t in_all = 0;
  while (in_all < from.size()) {
    ERR_clear_error();
    std::size_t count = 0;
    const int done = SSL_write_ex(tls_.get(), from.data() + in_all, from.size() - in_all, &count);
    in_all += count;
    if (done == 1) continue;
    if (SSL_get_error(tls_.get(), done) == SSL_ERROR_WANT_WRITE) break;
    return std::nullopt;
  }
  return in_all;
}

}  // namespace dance
