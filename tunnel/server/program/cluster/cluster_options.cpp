#include "tunnel/server/program/cluster/cluster_options.h"

#include <algorithm>

#include "core/base/printable.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

// USER:PASSWORD or a token, as it stands in a URL.
Result<std::string> read_login(const std::string& path) {
  const std::string option = "--cluster-login ";
  DANCE_TRY(auto text, read_secret(path));
  if (!text) return fail(option + printable(path) + ": no such file");
  while (text->ends_with('\n') || text->ends_with('\r')) text->pop_back();
  const auto is_allowed = [](char c) { return c > ' ' && c <= '~' && c != '@' && c != '/'; };
  if (text->empty() || !std::ranges::all_of(*text, is_allowed))
    return fail(option + printable(path) +
                ": one line with USER:PASSWORD or a token is needed, of printable ASCII without "
                "spaces, '@' and '/'");
  return std::move(*text);
}

}  // namespace

Result<NatsOptions> nats_options_of(const ClusterOptions& options) {
  NatsOptions nats = options.nats;
  nats.urls = nats_urls(options.urls);
  if (nats.urls.empty()) return fail("--cluster names no NATS server: nats://HOST:4222");
  if (std::ranges::any_of(
          nats.urls, [](const std::string& url) { return url.find('@') != std::string::npos; }))
    return fail(
        "--cluster: all users of this machine can read a user, password or token in a URL; write "
        "USER:PASSWORD into a file, chmod 600 it, and name it with --cluster-login FILE");
  if (!options.login.empty()) {
    DANCE_TRY(const std::string login, read_login(options.login));
    for (std::string& url : nats.urls) url.insert(url.find("://") + 3, login + "@");
  }
  if (!nats.credentials.empty()) {
    // Whether it is there, and what is in it, is checked where it is used.
    if (auto text = read_secret(nats.credentials); !text)
      return fail("--cluster-credentials " + text.error().what);
  }
  if (nats.certificate.empty() != nats.private_key.empty())
    return fail("--cluster-certificate and --cluster-private-key belong together");
  return nats;
}

void add_cluster_options(CommandLine& line, ClusterOptions& options, const std::string& what) {
  line.add("--cluster", options.urls, what);
  line.add("--cluster-login", options.login,
           "file with USER:PASSWORD, or a token, for NATS; only you may be able to read it (0600)");
  line.add("--cluster-credentials", options.nats.credentials,
           "file of the NATS user that this program is (.creds); only you may be able to read it");
  line.add("--cluster-authorities", options.nats.authorities,
           "PEM file of those whose signature the NATS servers' certificates bear (tls://)");
  line.add("--cluster-certificate", options.nats.certificate,
           "PEM file of this program's certificate, where NATS asks for one");
  line.add("--cluster-private-key", options.nats.private_key, "PEM file of its private key");
}

}  // namespace dance
