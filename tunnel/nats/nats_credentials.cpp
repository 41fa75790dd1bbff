#include "tunnel/nats/nats_credentials.h"

#include <nats/nats.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <span>
#include <vector>

#include "core/base/printable.h"

namespace dance {
namespace {

// Without padding, for URLs.
std::string url_base64(std::span<const unsigned char> bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                                   static_cast<int>(bytes.size()));
  text.resize(std::min(static_cast<std::size_t>(size), text.find('=')));
  std::replace(text.begin(), text.end(), '+', '-');
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
}

}  // namespace

Result<NatsProof> prove_nats_user(const std::string& path, const std::string& nonce) {
  const std::string option = "--cluster-credentials " + printable(path);
  std::ifstream in(path);
  if (!in) return fail(option + " cannot be read");
  // The lines behind the first and the second -----BEGIN: a user's JWT and its seed.
  std::vector<std::string> found;
  bool is_next = false;
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (is_next && !line.empty() && !line.starts_with("---")) found.push_back(line);
    is_next = line.starts_with("-----BEGIN") || (is_next && line.empty());
    OPENSSL_cleanse(line.data(), line.size());
  }
  const auto wipe = [&] {
    for (std::string& line : found) OPENSSL_cleanse(line.data(), line.size());
  };
  if (found.size() != 2) {
    wipe();
    return fail(option + " is no file of a NATS user");
  }
  nats_Open(-1);  // its tables, else no seed can be read
  unsigned char* signature = nullptr;
  int size = 0;
  const natsStatus status = nats_Sign(found[1].c_str(), nonce.c_str(), &signature, &size);
  NatsProof proof{found[0], ""};
  wipe();
  if (status != NATS_OK) return fail(option + ": no seed of a user");
  proof.signature = url_base64({signature, static_cast<std::size_t>(size)});
  std::free(signature);
  return proof;
}

}  // namespace dance
