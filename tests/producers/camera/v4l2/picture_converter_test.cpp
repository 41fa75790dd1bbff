#include "producers/camera/v4l2/picture_converter.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <algorithm>

#include "core/base/random.h"
#include "tests/producers/camera/v4l2/drawn_pictures.h"

namespace dance {
namespace {

PictureConverter converter_of(std::uint32_t fourcc, int width_px, int height_px,
                              int row_bytes = 0) {
  auto converter = PictureConverter::make({fourcc, width_px, height_px, row_bytes});
  EXPECT_TRUE(converter.has_value()) << (converter ? "" : converter.error().what);
  return std::move(*converter);
}

// Each part of a JPEG: where it begins and ends, with its mark.
std::vector<std::uint8_t> without_part(const std::vector<std::uint8_t>& jpeg, std::uint8_t mark) {
  std::vector<std::uint8_t> out(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  while (at + 4 <= jpeg.size() && jpeg[at + 1] != 0xda) {
    const std::size_t end = at + 2 + static_cast<std::size_t>(jpeg[at + 2] * 256 + jpeg[at + 3]);
    if (jpeg[at + 1] != mark) {
      out.insert(out.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at),
                 jpeg.begin() + static_cast<std::ptrdiff_t>(end));
    }
    at = end;
  }
  out.insert(out.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  return out;
}

TEST(PictureConverter, AcceptsJpegWithoutTablesAsWebcamsSendIt) {
  const cv::Mat seen = drawn_colours(96, 64);
  const std::vector<std::uint8_t> whole = jpeg_of(seen);
  const std::vector<std::uint8_t> bare = without_part(whole, 0xc4);
  ASSERT_LT(bare.size(), whole.size() - 300);
  PictureConverter converter = converter_of(V4L2_PIX_FMT_MJPEG, 96, 64);
  cv::Mat picture;
  ASSERT_TRUE(converter.convert(bare, picture));
  EXPECT_LT(mean_difference(picture, seen), 2.5);
}

TEST(PictureConverter, AcceptsBytesBehindAndBetweenThePartsOfAJpeg) {
  std::vector<std::uint8_t> jpeg = jpeg_of(drawn_colours(96, 64));
  jpeg.insert(jpeg.end(), 500, 0);
  PictureConverter converter = converter_of(V4L2_PIX_FMT_MJPEG, 96, 64);
  cv::Mat picture;
  EXPECT_TRUE(converter.convert(jpeg, picture));
  jpeg.insert(jpeg.begin() + 20, 7, 0x11);
  EXPECT_TRUE(converter.convert(jpeg, picture));
  EXPECT_LT(mean_difference(picture, drawn_colours(96, 64)), 2.5);
}

TEST(PictureConverter, AJpegOfAnotherSizeIsDamage) {
  PictureConverter converter = converter_of(V4L2_PIX_FMT_MJPEG, 96, 64);
  cv::Mat picture;
  EXPECT_FALSE(converter.convert(jpeg_of(drawn_colours(4000, 3000)), picture));
  EXPECT_FALSE(converter.convert(jpeg_of(drawn_colours(80, 64)), picture));
  EXPECT_TRUE(picture.empty());
}

TEST(PictureConverter, EveryJpegThatIsCutIsDamage) {
  const std::vector<std::uint8_t> jpeg = jpeg_of(drawn_colours(96, 64));
  PictureConverter converter = converter_of(V4L2_PIX_FMT_MJPEG, 96, 64);
  cv::Mat picture;
  // The end mark alone may be missing.
  for (std::size_t size = 0; size + 8 < jpeg.size(); size += 3) {
    EXPECT_FALSE(converter.convert(std::span(jpeg).first(size), picture)) << size;
  }
  EXPECT_TRUE(converter.convert(jpeg, picture));
}

TEST(PictureConverter, SurvivesBrokenJpegs) {
  const std::vector<std::uint8_t> jpeg = jpeg_of(drawn_colours(96, 64));
  PictureConverter converter = converter_of(V4L2_PIX_FMT_MJPEG, 96, 64);
  Random random(5);
  cv::Mat picture;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> broken = jpeg;
    const int faults = 1 + static_cast<int>(random.uniform() * 4);
    for (int k = 0; k < faults; ++k) {
      const auto at =
          static_cast<std::size_t>(random.uniform() * static_cast<double>(broken.size()));
      broken[at] = static_cast<std::uint8_t>(random.uniform() * 256);
    }
    converter.convert(broken, picture);
    EXPECT_LE(picture.total(), 112u * 80u);
  }
  ASSERT_TRUE(converter.convert(jpeg, picture));
  EXPECT_LT(mean_difference(picture, drawn_colours(96, 64)), 2.5);
}

TEST(PictureConverter, MissingBytesAreDamageAndTheLastPaddingIsNot) {
  constexpr int kPadded_bytes = 2 * 64 + 32;
  PictureConverter converter = converter_of(V4L2_PIX_FMT_YUYV, 64, 48, kPadded_bytes);
  const std::size_t least = 47u * kPadded_bytes + 128u;
  cv::Mat picture;
  const std::vector<std::uint8_t> bytes(least, 128);
  EXPECT_TRUE(converter.convert(bytes, picture));
  EXPECT_FALSE(converter.convert(std::span(bytes).first(least - 1), picture));
  EXPECT_FALSE(converter.convert({}, picture));
  PictureConverter planes = converter_of(V4L2_PIX_FMT_NV12, 64, 48);
  const std::vector<std::uint8_t> nv12(64u * 72u, 128);
  EXPECT_TRUE(planes.convert(nv12, picture));
  EXPECT_FALSE(planes.convert(std::span(nv12).first(nv12.size() - 1), picture));
}

TEST(PictureConverter, GreyHasNoColour) {
  PictureConverter converter = converter_of(V4L2_PIX_FMT_GREY, 4, 2);
  const std::vector<std::uint8_t> bytes{0, 50, 100, 150, 200, 250, 255, 1};
  cv::Mat picture;
  ASSERT_TRUE(converter.convert(bytes, picture));
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 2), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(picture.at<cv::Vec3b>(1, 1), cv::Vec3b(250, 250, 250));
}

TEST(PictureConverter, RefusesWhatCannotBe) {
  const auto why = [](const PixelLayout& layout) {
    const auto converter = PictureConverter::make(layout);
    return converter ? std::string("it was made") : converter.error().what;
  };
  EXPECT_EQ(why({v4l2_fourcc('H', '2', '6', '4'), 64, 48, 0}),
            "pictures in H264 cannot be read; YUYV, NV12, MJPG, JPEG and GREY can");
  EXPECT_EQ(why({V4L2_PIX_FMT_YUYV, 63, 48, 0}),
            "pictures of 63x48 in YUYV cannot be read; ask for another size");
  EXPECT_EQ(why({V4L2_PIX_FMT_NV12, 64, 47, 0}),
            "pictures of 64x47 in NV12 cannot be read; ask for another size");
  EXPECT_NE(why({V4L2_PIX_FMT_YUYV, 64, 48, 100}).find("has 100 bytes, which cannot be"),
            std::string::npos);
}

TEST(PictureConverter, HighPicturesAreReadSmallerWhereThatIsAskedFor) {
  const auto height = [](int of_px, int max_px) {
    return PictureConverter::make({V4L2_PIX_FMT_MJPEG, 3840, of_px, 0}, max_px)->height_px();
  };
  EXPECT_EQ(height(2160, 0), 2160);
  EXPECT_EQ(height(2160, 2160), 2160);
  EXPECT_EQ(height(2160, 2000), 1080);
  EXPECT_EQ(height(2160, 1079), 540);
  EXPECT_EQ(height(2160, 100), 270);
  EXPECT_EQ(height(480, 1080), 480);
}

}  // namespace
}  // namespace dance
