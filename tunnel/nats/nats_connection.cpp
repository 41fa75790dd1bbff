#include "tunnel/nats/nats_connection.h"

#include <pthread.h>

#include <optional>

#include "core/base/printable.h"
#include "tunnel/nats/nats_credentials.h"

// Where a connection is lost at the moment in which the library makes a watch of a bucket anew, it
// (3.4.1, js.c) detaches a thread that it does not have, and the process ends. Its calls come here
// instead, as a program's symbols go before those of its libraries.
extern "C" void natsThread_Detach(pthread_t* thread);
extern "C" void natsThread_Detach(pthread_t* thread) {
  if (thread != nullptr) pthread_detach(*thread);
}

namespace dance {
namespace {

constexpr std::int64_t kConnect_ms = 2000;
constexpr std::int64_t kPing_ms = 500;
constexpr int kUnansweredPings = 2;
constexpr std::int64_t kReconnect_ms = 100;
constexpr std::int64_t kPass_ms = 300;
// libnats 3.4.1 sends about one proof in 130 that no NATS server accepts, whoever signs it. Each
// try proves another nonce.
constexpr int kProofs = 3;

Error not_connected(natsStatus status, const NatsOptions& options) {
  const std::string at = shown_urls(options);
  const char* said = nats_GetLastError(nullptr);
  const std::string detail = said != nullptr ? printable(said) : natsStatus_GetText(status);
  if (status == NATS_CONNECTION_AUTH_FAILED || status == NATS_NOT_PERMITTED)
    return Error{"the NATS server at " + at +
                 " does not let us in: " + cure_of_nats_refusal(options)};
  if (status == NATS_NO_SERVER)
    return Error{"no NATS server answers at " + at + ": is nats-server running there?"};
  if (status == NATS_SSL_ERROR)
    return Error{"NATS at " + at +
                 ": no TLS: is --cluster-authorities the file of those who signed "
                 "its certificate, and does that bear the name in the URL? (" +
                 detail + ")"};
  if (status == NATS_SECURE_CONNECTION_WANTED)
    return Error{"NATS at " + at + ": no TLS: the server offers none: " + kTlsIsWanted};
  if (options.certificate.empty() && (status == NATS_PROTOCOL_ERROR || status == NATS_IO_ERROR ||
                                      status == NATS_CONNECTION_CLOSED || status == NATS_ERR))
    return Error{"the NATS server at " + at +
                 " ends the connection: it may ask for a certificate: "
                 "--cluster-certificate and --cluster-private-key (" +
                 detail + ")"};
  return Error{"NATS at " + at + ": " + detail};
}

// The step of the options that failed first.
class Setting {
 public:
  void operator()(natsStatus status, std::string what) {
    if (failed_ || status == NATS_OK) return;
    const char* said = nats_GetLastError(nullptr);
    failed_ = Error{std::move(what) + ": " +
                    (said != nullptr ? printable(said) : natsStatus_GetText(status))};
  }
  const std::optional<Error>& failed() const { return failed_; }

 private:
  std::optional<Error> failed_;
};

std::optional<Error> set(natsOptions* made, const NatsOptions& options, const NatsCalls& on) {
  Setting check;
  std::vector<const char*> urls;
  for (const std::string& url : options.urls) urls.push_back(url.c_str());
  check(natsOptions_SetServers(made, urls.data(), static_cast<int>(urls.size())),
        "--cluster " + shown_urls(options));
  check(natsOptions_SetName(made, options.name.c_str()), "NATS client's name");
  // Its own messages would come back, and what is old would be sent after a break.
  check(natsOptions_SetNoEcho(made, true), "NATS");
  check(natsOptions_SetSendAsap(made, true), "NATS");
  check(natsOptions_SetTimeout(made, kConnect_ms), "NATS");
  check(natsOptions_SetPingInterval(made, kPing_ms), "NATS");
  check(natsOptions_SetMaxPingsOut(made, kUnansweredPings), "NATS");
  check(natsOptions_SetMaxReconnect(made, -1), "NATS");
  check(natsOptions_SetReconnectWait(made, kReconnect_ms), "NATS");
  check(natsOptions_SetReconnectJitter(made, kReconnect_ms, kReconnect_ms), "NATS");
  check(natsOptions_UseGlobalMessageDelivery(made, true), "NATS");
  if (!options.credentials.empty())
    check(natsOptions_SetUserCredentialsFromFiles(made, options.credentials.c_str(), nullptr),
          "--cluster-credentials " + printable(options.credentials));
  if (!options.authorities.empty())
    check(natsOptions_LoadCATrustedCertificates(made, options.authorities.c_str()),
          "--cluster-authorities " + printable(options.authorities));
  if (!options.certificate.empty())
    check(natsOptions_LoadCertificatesChain(made, options.certificate.c_str(),
                                            options.private_key.c_str()),
          "--cluster-certificate " + printable(options.certificate));
  // Else a server that has not been authenticated would decide whether there is TLS.
  if (wants_tls(options)) check(natsOptions_SetSecure(made, true), "NATS: TLS");
  if (on.reconnected != nullptr)
    check(natsOptions_SetReconnectedCB(made, on.reconnected, on.closure), "NATS");
  if (on.error != nullptr) check(natsOptions_SetErrorHandler(made, on.error, on.closure), "NATS");
  return check.failed();
}

}  // namespace

bool reader_has_passed(natsConnection* connection) {
  return natsConnection_Status(connection) == NATS_CONN_STATUS_CONNECTED &&
         natsConnection_FlushTimeout(connection, kPass_ms) == NATS_OK;
}

// The library releases what takes the answers before it ends the thread that hands them over: none
// may be under way.
void close_nats(natsConnection* connection) {
  reader_has_passed(connection);
  natsConnection_Close(connection);
}

Result<NatsHandle<natsConnection>> connect_nats(const NatsOptions& options, const NatsCalls& on) {
  // The library says of a wrong file only that the connection ended.
  if (!options.credentials.empty())
    if (const auto proof = prove_nats_user(options.credentials, "any"); !proof)
      return tl::make_unexpected(proof.error());
  natsOptions* made = nullptr;
  if (natsOptions_Create(&made) != NATS_OK) return fail("NATS: no memory");
  const NatsHandle<natsOptions> of(made);
  if (const auto failed = set(made, options, on)) return tl::make_unexpected(*failed);
  natsConnection* connection = nullptr;
  natsStatus status = NATS_CONNECTION_AUTH_FAILED;
  const int most = options.credentials.empty() ? 1 : kProofs;
  for (int i = 0; i < most && status == NATS_CONNECTION_AUTH_FAILED; ++i)
    status = natsConnection_Connect(&connection, made);
  if (status != NATS_OK) return tl::make_unexpected(not_connected(status, options));
  return NatsHandle<natsConnection>(connection);
}

}  // namespace dance
