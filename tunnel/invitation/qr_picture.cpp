// QR codes as text and as a picture.
#include "tunnel/invitation/qr_code.h"

namespace dance {

std::string qr_text(const QrCode& code, bool has_colours) {
  std::string text;
  const int begin = -QrCode::kQuiet, end = code.size + QrCode::kQuiet;
  for (int y = begin; y < end; y += 2) {
    if (has_colours) text += "\033[40;97m";
    for (int x = begin; x < end; ++x) {
      const bool upper = !code.is_dark(x, y);
      const bool lower = y + 1 < end && !code.is_dark(x, y + 1);
      text += upper ? (lower ? "█" : "▀") : (lower ? "▄" : " ");
    }
    text += has_colours ? "\033[0m\n" : "\n";
  }
  return text;
}

std::string qr_svg(const QrCode& code) {
  const std::string side = std::to_string(code.size + 2 * QrCode::kQuiet);
  std::string text = R"(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="480" height="480" viewBox="0 0 )" +
                     side + " " + side + R"(" shape-rendering="crispEdges">
<rect width=")" + side +
                     R"(" height=")" + side +
                     R"(" fill="#ffffff"/>
<path fill="#000000" d=")";
  for (int y = 0; y < code.size; ++y)
    for (int x = 0; x < code.size; ++x) {
      if (!code.is_dark(x, y)) continue;
      int length = 1;
      while (code.is_dark(x + length, y)) ++length;
      text += "M" + std::to_string(x + QrCode::kQuiet) + " " + std::to_string(y + QrCode::kQuiet) +
              "h" + std::to_string(length) + "v1h-" + std::to_string(length) + "z";
      x += length;
    }
  return text + "\"/>\n</svg>\n";
}

}  // namespace dance
