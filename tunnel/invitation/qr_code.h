// A text as a QR code: for a terminal and for a file.
//
// Units/frames: modules, the squares of the code; (0, 0) is the upper left one.
// Ownership:    plain values.
// Threads:      any.
// Failure:      make_qr_code() says that the text is too long, or that this build has no QR codes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dance {

struct QrCode {
  // The quiet zone that a reader wants around the code.
  static constexpr int kQuiet = 4;

  int size = 0;            // modules in a row
  std::vector<bool> dark;  // row by row

  // Outside the code everything is light.
  bool is_dark(int x, int y) const {
    return x >= 0 && y >= 0 && x < size && y < size &&
           dark[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                static_cast<std::size_t>(x)];
  }
};

// Error correction of level M: readable with a seventh of it spoilt.
Result<QrCode> make_qr_code(std::string_view text);

// Two rows of modules in each line of characters, light ones painted; `has_colours`: white on black
// whatever the terminal's own colours are.
std::string qr_text(const QrCode& code, bool has_colours);
std::string qr_svg(const QrCode& code);

}  // namespace dance
