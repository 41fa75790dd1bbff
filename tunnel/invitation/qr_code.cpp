#include "tunnel/invitation/qr_code.h"

#include <qrencode.h>

#include <memory>

namespace dance {
namespace {

struct QrDeleter {
  void operator()(QRcode* code) const { QRcode_free(code); }
};

}  // namespace

Result<QrCode> make_qr_code(std::string_view text) {
  const std::unique_ptr<QRcode, QrDeleter> made(
      QRcode_encodeData(static_cast<int>(text.size()),
                        reinterpret_cast<const unsigned char*>(text.data()), 0, QR_ECLEVEL_M));
  if (!made)
    return fail("no QR code holds a text of " + std::to_string(text.size()) +
                " characters: pass the line itself on");
  QrCode code;
  code.size = made->width;
  const std::size_t count =
      static_cast<std::size_t>(made->width) * static_cast<std::size_t>(made->width);
  for (std::size_t i = 0; i < count; ++i) code.dark.push_back((made->data[i] & 1) != 0);
  return code;
}

}  // namespace dance
