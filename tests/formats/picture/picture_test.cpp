#include "formats/picture/picture.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <cstdlib>
#include <string>

#include "formats/picture/jpeg_writer.h"
#include "formats/picture/orientation.h"
#include "formats/picture/png_writer.h"
#include "tests/formats/picture/packed_pictures.h"

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;

void expect_ramp(const RgbaPicture& picture, int width_px, int height_px, int within) {
  ASSERT_EQ(picture.width_px, width_px);
  ASSERT_EQ(picture.height_px, height_px);
  const Bytes want = test::ramp(width_px, height_px);
  ASSERT_EQ(picture.rgba.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i)
    ASSERT_LE(std::abs(int{picture.rgba[i]} - int{want[i]}), within) << i;
}

TEST(RgbaPicture, PngAndWebpComeBackExactlyJpegNearly) {
  auto picture = read_picture(test::png(20, 12));
  ASSERT_TRUE(picture) << picture.error().what;
  expect_ramp(*picture, 20, 12, 0);
  picture = read_picture(test::webp(20, 12));
  ASSERT_TRUE(picture) << picture.error().what;
  expect_ramp(*picture, 20, 12, 0);
  for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
    picture = read_picture(test::jpeg(20, 12, flags));
    ASSERT_TRUE(picture) << picture.error().what;
    expect_ramp(*picture, 20, 12, 6);
  }
}

TEST(PngWriter, PixelsComeBackRowByRow) {
  constexpr int kWidth_px = 5, kHeight_px = 3;
  Bytes rgb, rgba;
  for (std::uint8_t i = 0; i < kWidth_px * kHeight_px; ++i)
    for (const int value : {10 * i, 255 - i, 7 * i, 100 + i}) {
      rgba.push_back(static_cast<std::uint8_t>(value));
      if (rgba.size() % 4 != 0) rgb.push_back(rgba.back());
    }
  Bytes opaque = rgba;
  for (std::size_t i = 3; i < opaque.size(); i += 4) opaque[i] = 255;
  constexpr std::size_t kColourType = 25;  // in the file's first chunk
  const auto expect_file = [&](const Result<Bytes>& file, const Bytes& pixels, int colour_type) {
    ASSERT_TRUE(file) << file.error().what;
    EXPECT_EQ((*file)[kColourType], colour_type);
    const auto picture = read_picture(*file);
    ASSERT_TRUE(picture) << picture.error().what;
    EXPECT_EQ(picture->width_px, kWidth_px);
    EXPECT_EQ(picture->height_px, kHeight_px);
    EXPECT_EQ(picture->rgba, pixels);
  };
  expect_file(png_of_rgb(kWidth_px, kHeight_px, rgb), opaque, 2);
  expect_file(png_of_rgba(kWidth_px, kHeight_px, opaque), opaque, 2);
  expect_file(png_of_rgba(kWidth_px, kHeight_px, rgba), rgba, 6);
}

TEST(PngWriter, PixelsThatDoNotFitTheSizeAreRefused) {
  const Bytes pixels(4 * 5 * 3);
  EXPECT_FALSE(png_of_rgba(5, 4, pixels));
  EXPECT_FALSE(png_of_rgb(5, 3, pixels));
  EXPECT_FALSE(png_of_rgb(0, 0, {}));
  EXPECT_FALSE(png_of_rgba(-5, -3, pixels));
}

TEST(JpegWriter, PixelsComeBackNearly) {
  Bytes grey(20 * 12 * 3);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(60 + i / 9);
  const auto file = jpeg_of_rgb(20, 12, grey, 95);
  ASSERT_TRUE(file) << file.error().what;
  const auto picture = read_picture(*file);
  ASSERT_TRUE(picture) << picture.error().what;
  ASSERT_EQ(picture->rgba.size(), 20u * 12 * 4);
  for (std::size_t i = 0; i < grey.size(); ++i)
    ASSERT_NEAR(picture->rgba[i / 3 * 4 + i % 3], grey[i], 8) << i;
  const auto coarse = jpeg_of_rgb(20, 12, grey, 10);
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->size(), file->size());
  EXPECT_FALSE(jpeg_of_rgb(20, 11, grey, 95));
  EXPECT_FALSE(jpeg_of_rgb(0, 0, {}, 95));
}

TEST(Orientation, IsFoundInJpegAndPngInEitherByteOrder) {
  for (const Bytes& picture : {test::jpeg(16, 16), test::png(9, 7)}) {
    EXPECT_EQ(exif_orientation(picture), 1);
    for (const bool is_little : {true, false}) {
      for (std::uint8_t noted = 1; noted <= 8; ++noted)
        EXPECT_EQ(exif_orientation(test::with_exif(picture, test::exif(noted, is_little))), noted);
      for (const int wrong : {0, 9, 255})
        EXPECT_EQ(exif_orientation(test::with_exif(
                      picture, test::exif(static_cast<std::uint8_t>(wrong), is_little))),
                  1);
    }
  }
  EXPECT_EQ(exif_orientation(test::webp(9, 7)), 1);
  EXPECT_EQ(exif_orientation({}), 1);
}

TEST(Orientation, WhatIsDamagedIsLeftAsItIs) {
  for (const Bytes& picture : {test::jpeg(16, 16), test::png(9, 7)}) {
    const Bytes whole = test::with_exif(picture, test::exif(6, true));
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const int turned = exif_orientation(std::span(whole).first(size));
      EXPECT_TRUE(turned == 1 || turned == 6) << size;
    }
    Bytes bytes = whole;
    for (std::size_t i = 0; i < bytes.size() * 8; ++i) {
      bytes[i / 8] ^= static_cast<std::uint8_t>(1u << i % 8);
      const int turned = exif_orientation(bytes);
      EXPECT_TRUE(turned >= 1 && turned <= 8) << i;
      bytes[i / 8] ^= static_cast<std::uint8_t>(1u << i % 8);
    }
  }
}

TEST(RgbaPicture, TheKindIsToldByTheFirstBytes) {
  EXPECT_EQ(picture_kind(test::png(1, 1)), PictureKind::kPng);
  EXPECT_EQ(picture_kind(test::jpeg(1, 1)), PictureKind::kJpeg);
  EXPECT_EQ(picture_kind(test::webp(1, 1)), PictureKind::kWebp);
  EXPECT_EQ(picture_kind({}), PictureKind::kNone);
  EXPECT_EQ(picture_kind(Bytes{'G', 'I', 'F', '8'}), PictureKind::kNone);
}

TEST(RgbaPicture, TheSizeIsCheckedBeforeAPixelIsDecoded) {
  PictureLimits limits;
  limits.side_px = 19;
  for (const Bytes& bytes : {test::png(20, 12), test::jpeg(20, 12), test::webp(20, 12)}) {
    const auto picture = read_picture(bytes, limits);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().what.find("20 x 12"), std::string::npos) << picture.error().what;
    EXPECT_EQ(decoded_bytes(bytes), 20u * 12 * 4);
  }
  limits = {};
  limits.decoded_bytes = 20 * 12 * 4 - 1;
  EXPECT_FALSE(read_picture(test::png(20, 12), limits));
}

TEST(RgbaPicture, AReducedPictureIsTheMeanOfSquares) {
  RgbaPicture picture{4, 2, {}};
  for (int i = 0; i < 8; ++i)
    picture.rgba.insert(picture.rgba.end(), {static_cast<std::uint8_t>(10 * i), 0, 200, 255});
  const RgbaPicture half = reduced(picture, 2);
  ASSERT_EQ(half.width_px, 2);
  ASSERT_EQ(half.height_px, 1);
  EXPECT_EQ(half.rgba, (Bytes{25, 0, 200, 255, 45, 0, 200, 255}));
  EXPECT_EQ(reduced(picture, 4).rgba, picture.rgba);
  // Sides that do not divide evenly: the last square is smaller.
  const RgbaPicture third = reduced({5, 5, Bytes(100, 77)}, 2);
  EXPECT_EQ(third.width_px, 2);
  EXPECT_EQ(third.rgba, Bytes(16, 77));
}

TEST(RgbaPicture, TransparentPixelsDoNotDarkenWhatIsBesideThem) {
  const RgbaPicture picture{2, 1, {200, 100, 50, 255, 0, 0, 0, 0}};
  EXPECT_EQ(reduced(picture, 1).rgba, (Bytes{200, 100, 50, 128}));
  EXPECT_EQ(reduced({2, 1, {10, 10, 10, 0, 30, 30, 30, 0}}, 1).rgba, (Bytes{20, 20, 20, 0}));
}

TEST(RgbaPicture, DamageIsAnErrorAndNeverMore) {
  for (const Bytes& whole : {test::png(9, 7), test::jpeg(16, 16),
                             test::jpeg(16, 16, TJFLAG_PROGRESSIVE), test::webp(9, 7)}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto picture =
          read_picture(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
      EXPECT_TRUE(picture || !picture.error().what.empty());
    }
    Bytes bytes = whole;
    for (std::size_t i = 0; i < bytes.size() * 8; ++i) {
      bytes[i / 8] ^= static_cast<std::uint8_t>(1u << i % 8);
      const auto picture = read_picture(bytes, {64, 1u << 16, 16});
      if (picture) {
        EXPECT_LE(picture->width_px, 16);
        EXPECT_EQ(picture->rgba.size(), std::size_t{4} *
                                            static_cast<std::size_t>(picture->width_px) *
                                            static_cast<std::size_t>(picture->height_px));
      } else {
        for (const char c : picture.error().what) EXPECT_TRUE(c >= 0x20 && c < 0x7f);
      }
      bytes[i / 8] ^= static_cast<std::uint8_t>(1u << i % 8);
    }
  }
}

TEST(RgbaPicture, AJpegOfVeryManyScansIsRefusedBeforeItIsDecoded) {
  Bytes bytes = test::jpeg(2048, 2048, TJFLAG_PROGRESSIVE);
  ASSERT_TRUE(read_picture(bytes));
  for (int scan = 0; scan < 100; ++scan)
    bytes.insert(bytes.end() - 2, {0xff, 0xda, 0, 8, 1, 1, 0, 1, 5, 0x21});
  const auto picture = read_picture(bytes);
  ASSERT_FALSE(picture);
  EXPECT_NE(picture.error().what.find("scans"), std::string::npos);
}

Bytes chunk(std::uint32_t length, std::string_view name, const Bytes& data) {
  Bytes out;
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(length >> shift));
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  uLong sum = crc32(0, out.data() + 4, static_cast<uInt>(out.size() - 4));
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(sum >> shift));
  return out;
}
constexpr std::ptrdiff_t kEndOfPngHead = 33;

TEST(RgbaPicture, AChunkThatTellsMoreThanThereIsTakesNoMemory) {
  Bytes bytes = test::png(9, 7);
  const Bytes bomb = chunk(0x4e000026, "eXIf", {'M', 'M', 0, 42});
  bytes.insert(bytes.begin() + kEndOfPngHead, bomb.begin(), bomb.end());
  const auto picture = read_picture(bytes);
  ASSERT_FALSE(picture);
  EXPECT_NE(picture.error().what.find("within a chunk"), std::string::npos) << picture.error().what;
  EXPECT_FALSE(read_picture(std::span(bytes).first(8)));
}

TEST(RgbaPicture, TextsThatUnpackToAGigabyteAreLeftOut) {
  // 4 MB of one letter, packed, in 250 texts.
  const Bytes letters(4'000'000, 'a');
  uLongf size = compressBound(letters.size());
  Bytes text = {'k', 0, 0};
  text.resize(text.size() + size);
  ASSERT_EQ(compress(text.data() + 3, &size, letters.data(), letters.size()), Z_OK);
  text.resize(3 + size);
  const Bytes packed = chunk(static_cast<std::uint32_t>(text.size()), "zTXt", text);
  Bytes bytes = test::png(9, 7);
  for (int i = 0; i < 250; ++i)
    bytes.insert(bytes.begin() + kEndOfPngHead, packed.begin(), packed.end());
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  const auto picture = read_picture(bytes);
  getrusage(RUSAGE_SELF, &after);
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->rgba, test::ramp(9, 7));
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100'000) << "kB";
}

// A thumbnail in a segment before the image, a film behind it.
TEST(RgbaPicture, WhatLiesInsideAndBehindAJpegIsNoScanOfIt) {
  Bytes bytes = test::jpeg(2048, 2048, TJFLAG_PROGRESSIVE);
  Bytes segment = {0xff, 0xe1, 0, 202};
  for (int scan = 0; scan < 100; ++scan) segment.insert(segment.end(), {0xff, 0xda});
  bytes.insert(bytes.begin() + 2, segment.begin(), segment.end());
  for (int scan = 0; scan < 100; ++scan) bytes.insert(bytes.end(), {0xff, 0xda, 0, 2});
  const auto picture = read_picture(bytes);
  EXPECT_TRUE(picture) << picture.error().what;
}

TEST(RgbaPicture, TheLimitThatAPictureExceedsIsTheOneThatIsNamed) {
  const Bytes bytes = test::jpeg(300, 200);
  const auto wide = read_picture(bytes, {256, std::size_t{1} << 28, 0});
  ASSERT_FALSE(wide);
  EXPECT_NE(wide.error().what.find("256 a side"), std::string::npos) << wide.error().what;
  const auto large = read_picture(test::jpeg(1100, 1000), {4096, 4'000'000, 0});
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().what.find("1 megapixels"), std::string::npos) << large.error().what;
}

}  // namespace
}  // namespace dance
