// The key of one handshake that both of its ends know: derived from their identity keys, or,
// between programs of one user, the content of a file. 32 bytes, written as 43 characters (base64
// with - and _).
//
// Units/frames: none.
// Ownership:    plain values; wiped when they go.
// Threads:      none inside.
// Failure:      parse() gives nullopt for anything that text() never writes; make() panics only
//               where the kernel has no random numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace dance {

class PresharedKey {
 public:
  static constexpr std::size_t kBytes = 32;
  static constexpr std::size_t kTextLength = 43;

  PresharedKey() = default;
  PresharedKey(const PresharedKey&) = default;
  PresharedKey& operator=(const PresharedKey&) = default;
  ~PresharedKey();

  static PresharedKey make();
  static std::optional<PresharedKey> parse(std::string_view text);
  static PresharedKey of(std::span<const std::uint8_t, kBytes> bytes);
  std::string text() const;

  const std::array<std::uint8_t, kBytes>& bytes() const { return bytes_; }
  bool operator==(const PresharedKey& o) const;

 private:
  std::array<std::uint8_t, kBytes> bytes_{};
};

}  // namespace dance
