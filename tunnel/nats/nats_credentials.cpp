#include "tunnel/nats/nats_credentials.h"

#include <nats/nats.h>
#include <openssl/crypto.h>

#include <cstdlib>
#include <fstream>
#include <vector>

#include "core/base/printable.h"
#include "tunnel/seal/keys/base64url.h"

namespace dance {
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
  proof.signature = base64url({signature, static_cast<std::size_t>(size)});
  std::free(signature);
  return proof;
}

}  // namespace dance
