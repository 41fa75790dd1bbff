#include "tunnel/nats/nats_options.h"

#include <algorithm>
#include <sstream>

#include "core/base/printable.h"

namespace dance {

std::vector<std::string> nats_urls(const std::string& list) {
  std::vector<std::string> urls;
  std::istringstream in(list);
  for (std::string url; std::getline(in, url, ',');) {
    if (url.empty()) continue;
    urls.push_back(url.find("://") == std::string::npos ? "nats://" + url : url);
  }
  return urls;
}

bool wants_tls(const NatsOptions& options) {
  return !options.authorities.empty() || !options.certificate.empty() ||
         std::ranges::any_of(options.urls,
                             [](const std::string& url) { return url.starts_with("tls://"); });
}

std::string shown_urls(const NatsOptions& options) {
  std::string text;
  for (const std::string& url : options.urls) {
    const std::size_t scheme = url.find("://");
    const std::size_t begin = scheme == std::string::npos ? 0 : scheme + 3;
    const std::size_t at = url.rfind('@');
    const std::string host = at == std::string::npos ? url.substr(begin) : url.substr(at + 1);
    text += (text.empty() ? "" : ", ") + url.substr(0, begin) + host;
  }
  return printable(text);
}

std::string cure_of_nats_refusal(const NatsOptions& options) {
  if (!options.credentials.empty())
    return printable(options.credentials) + " is no credentials file of a user of it";
  if (!options.certificate.empty())
    return printable(options.certificate) + " is the certificate of none of its users";
  const auto names_a_user = [](const std::string& url) {
    return url.find('@') != std::string::npos;
  };
  if (std::ranges::any_of(options.urls, names_a_user))
    return "NATS does not accept the login in the file of --cluster-login";
  return "give --cluster-certificate and --cluster-private-key, --cluster-credentials or "
         "--cluster-login";
}

}  // namespace dance
