#include "formats/picture/jpeg_writer.h"

#include <turbojpeg.h>

#include <memory>
#include <string>

#include "core/base/printable.h"

namespace dance {
namespace {

struct DestroyCompressor {
  void operator()(void* handle) const { tjDestroy(handle); }
};
struct FreeJpeg {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

}  // namespace

Result<std::vector<std::uint8_t>> jpeg_of_rgb(int width_px, int height_px,
                                              std::span<const std::uint8_t> rgb, int quality) {
  if (width_px < 1 || height_px < 1 ||
      rgb.size() !=
          std::size_t{3} * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px))
    return fail("a picture has no size");
  const std::unique_ptr<void, DestroyCompressor> handle(tjInitCompress());
  if (!handle) return fail("no memory for a JPEG");
  unsigned char* packed = nullptr;
  unsigned long size = 0;
  const int code = tjCompress2(handle.get(), rgb.data(), width_px, 0, height_px, TJPF_RGB, &packed,
                               &size, TJSAMP_420, quality, 0);
  const std::unique_ptr<unsigned char, FreeJpeg> owned(packed);
  if (code != 0)
    return fail("a picture cannot be written as JPEG: " + printable(tjGetErrorStr2(handle.get())));
  return std::vector<std::uint8_t>(packed, packed + size);
}

}  // namespace dance
