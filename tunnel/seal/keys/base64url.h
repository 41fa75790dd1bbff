// Base64 with - and _ and without padding (RFC 4648, section 5), in its one canonical form: each
// byte string has one text.
//
// Failure: decode_base64url() returns false for any text that base64url() would not write for
//          `out.size()` bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dance {

std::string base64url(std::span<const std::uint8_t> bytes);
// Fills all of `out`, which is undefined on failure.
bool decode_base64url(std::string_view text, std::span<std::uint8_t> out);

}  // namespace dance
