#include "producers/camera/region/region_sampler.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace dance {
namespace {

// Red, green and blue side by side in one register; the fourth is unused.
using Colour = float __attribute__((vector_size(16)));
static_assert(std::endian::native == std::endian::little);

Colour colour_of(std::uint32_t red_green_blue) {
#ifdef __SSE2__
  // What compilers make of the line below takes as long as three single pixels.
  const __m128i zero = _mm_setzero_si128();
  const __m128i bytes = _mm_cvtsi32_si128(static_cast<int>(red_green_blue));
  return _mm_cvtepi32_ps(_mm_unpacklo_epi16(_mm_unpacklo_epi8(bytes, zero), zero));
#else
  using Bytes = std::uint8_t __attribute__((vector_size(4)));
  Bytes bytes;
  std::memcpy(&bytes, &red_green_blue, sizeof bytes);
  return __builtin_convertvector(bytes, Colour);
#endif
}
// Both read four bytes, of which three are the pixel's: one takes the one behind it, the other the
// one before.
Colour pixel_before_another(const std::uint8_t* pixel) {
  std::uint32_t word;
  std::memcpy(&word, pixel, sizeof word);
  return colour_of(__builtin_bswap32(word) >> 8);
}
Colour pixel_behind_another(const std::uint8_t* pixel) {
  std::uint32_t word;
  std::memcpy(&word, pixel - 1, sizeof word);
  return colour_of(__builtin_bswap32(word));
}

struct Reading {
  const std::uint8_t* pixels;
  std::size_t row_bytes;
  float last_x, last_y;
  float gain, least;

  bool is_beyond(float x, float y) const {
    return x < -0.5f || y < -0.5f || x > last_x + 0.5f || y > last_y + 0.5f;
  }
  // Where there is a next pixel and a next row: the same numbers as between(), three at a time.
  void within(float x, float y, float* to) const {
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
    const std::uint8_t* upper =
        pixels + static_cast<std::size_t>(row) * row_bytes + 3 * static_cast<std::size_t>(column);
    const std::uint8_t* lower = upper + row_bytes;
    const Colour ul = pixel_before_another(upper), ll = pixel_before_another(lower);
    const Colour u = ul + fx * (pixel_behind_another(upper + 3) - ul);
    const Colour l = ll + fx * (pixel_behind_another(lower + 3) - ll);
    const Colour colour = least + gain * (u + fy * (l - u));
    std::memcpy(to, &colour, 3 * sizeof *to);
  }
  // The next pixel and the next row stand so many bytes behind.
  void between(float x, float y, std::size_t right, std::size_t down, float* to) const {
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
    const std::uint8_t* upper =
        pixels + static_cast<std::size_t>(row) * row_bytes + 3 * static_cast<std::size_t>(column);
    const std::uint8_t* lower = upper + down;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto ul = static_cast<float>(upper[c]), ll = static_cast<float>(lower[c]);
      const float u = ul + fx * (static_cast<float>(upper[c + right]) - ul);
      const float l = ll + fx * (static_cast<float>(lower[c + right]) - ll);
      to[2 - c] = least + gain * (u + fy * (l - u));
    }
  }
  void at_border(float wished_x, float wished_y, float* to) const {
    const float x = std::clamp(wished_x, 0.0f, last_x), y = std::clamp(wished_y, 0.0f, last_y);
    between(x, y, x < last_x ? 3 : 0, y < last_y ? row_bytes : 0, to);
  }
};

}  // namespace

void sample_region(const cv::Mat& picture, const BodyRegion& region, int size_px, Beyond beyond,
                   float least, float most, std::span<float> out) {
  const float step = region.side_px / static_cast<float>(size_px);
  const float along_x = std::cos(region.turn_rad) * step;
  const float along_y = std::sin(region.turn_rad) * step;
  const Reading reading{picture.data,
                        picture.step[0],
                        static_cast<float>(picture.cols - 1),
                        static_cast<float>(picture.rows - 1),
                        (most - least) / 255.0f,
                        least};
  const float first = 0.5f - 0.5f * static_cast<float>(size_px);
  float* to = out.data();
  for (int row = 0; row < size_px; ++row) {
    const float v = static_cast<float>(row) + first;
    // From here on (0, 0) is the middle of the left upper pixel.
    const float start_x = region.centre_x_px - 0.5f + first * along_x - v * along_y;
    const float start_y = region.centre_y_px - 0.5f + first * along_y + v * along_x;
    for (int column = 0; column < size_px; ++column, to += 3) {
      const float x = start_x + static_cast<float>(column) * along_x;
      const float y = start_y + static_cast<float>(column) * along_y;
      if (x >= 0.0f && y >= 0.0f && x < reading.last_x && y < reading.last_y)
        reading.within(x, y, to);
      else if (beyond == Beyond::kBlack && reading.is_beyond(x, y))
        to[0] = to[1] = to[2] = least;
      else
        reading.at_border(x, y, to);
    }
  }
}

}  // namespace dance
