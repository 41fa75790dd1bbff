// SHA-256 of a file's bytes, by OpenSSL.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include <memory>
#include <span>

#include "core/base/file_hash.h"

namespace dance {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::span<const std::uint8_t> bytes);
  FileHash finish();  // once

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

FileHash sha256_of(std::span<const std::uint8_t> bytes);

}  // namespace dance
