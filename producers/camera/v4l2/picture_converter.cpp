#include "producers/camera/v4l2/picture_converter.h"

#include <linux/videodev2.h>
#include <turbojpeg.h>

#include <cstring>
#include <opencv2/imgproc.hpp>

#include "producers/camera/v4l2/video_mode.h"

namespace dance {
namespace {

bool is_jpeg(std::uint32_t fourcc) {
  return fourcc == V4L2_PIX_FMT_MJPEG || fourcc == V4L2_PIX_FMT_JPEG;
}

// Coders work in blocks: a picture may come with its last block whole.
constexpr int kJpegSlack_px = 16;

cv::Mat view(std::span<const std::uint8_t> bytes, std::size_t offset, int rows, int columns,
             int type, int row_bytes) {
  // OpenCV has no view of constant bytes; nothing writes through this one.
  return cv::Mat(rows, columns, type, const_cast<std::uint8_t*>(bytes.data() + offset),
                 static_cast<std::size_t>(row_bytes));
}

}  // namespace

class PictureConverter::Jpeg {
 public:
  Jpeg(const PixelLayout& layout, int max_height_px)
      : handle_(tjInitDecompress()), layout_(layout) {
    if (max_height_px > 0) {
      while (denominator_ < 8 && scaled(layout.height_px) > max_height_px) denominator_ *= 2;
    }
  }
  ~Jpeg() {
    if (handle_ != nullptr) tjDestroy(handle_);
  }
  Jpeg(const Jpeg&) = delete;
  Jpeg& operator=(const Jpeg&) = delete;

  bool is_ready() const { return handle_ != nullptr; }
  int scaled(int size_px) const { return TJSCALED(size_px, (tjscalingfactor{1, denominator_})); }

  bool decode(std::span<const std::uint8_t> bytes, cv::Mat& bgr) {
    if (handle_ == nullptr) return false;
    // Old interfaces of C take a size as a long.
    const auto size = static_cast<unsigned long>(bytes.size());
    int width_px = 0, height_px = 0, sampling = 0, colours = 0;
    if (tjDecompressHeader3(handle_, bytes.data(), size, &width_px, &height_px, &sampling,
                            &colours) != 0 &&
        !is_only_filling()) {
      // After a header that it could not read TurboJPEG 2.1 refuses all others.
      tjDestroy(handle_);
      handle_ = tjInitDecompress();
      return false;
    }
    // The header's size is not trusted for allocating memory.
    if (width_px < layout_.width_px || width_px >= layout_.width_px + kJpegSlack_px ||
        height_px < layout_.height_px || height_px >= layout_.height_px + kJpegSlack_px) {
      return false;
    }
    bgr.create(scaled(height_px), scaled(width_px), CV_8UC3);
    return tjDecompress2(handle_, bytes.data(), size, bgr.data, bgr.cols,
                         static_cast<int>(bgr.step), bgr.rows, TJPF_BGR,
                         TJFLAG_FASTUPSAMPLE) == 0 ||
           is_only_filling();
  }

 private:
  // Filling bytes between the parts of a JPEG, as many a webcam sends them, harm nothing. All else
  // that is only warned of is a picture with a grey or smeared rest.
  bool is_only_filling() const {
    return tjGetErrorCode(handle_) == TJERR_WARNING &&
           std::strstr(tjGetErrorStr2(handle_), "extraneous bytes") != nullptr;
  }

  tjhandle handle_;
  PixelLayout layout_;
  int denominator_ = 1;
};

Result<PictureConverter> PictureConverter::make(const PixelLayout& layout, int max_height_px) {
  const std::string name = text_of_fourcc(layout.fourcc);
  PixelLayout exact = layout;
  int least_row_bytes = 0;
  bool is_even = true;
  switch (layout.fourcc) {
    case V4L2_PIX_FMT_YUYV:
      least_row_bytes = 2 * layout.width_px;
      is_even = layout.width_px % 2 == 0;
      break;
    case V4L2_PIX_FMT_NV12:
      least_row_bytes = layout.width_px;
      is_even = layout.width_px % 2 == 0 && layout.height_px % 2 == 0;
      break;
    case V4L2_PIX_FMT_GREY:
      least_row_bytes = layout.width_px;
      break;
    case V4L2_PIX_FMT_MJPEG:
    case V4L2_PIX_FMT_JPEG:
      break;
    default:
      return fail("pictures in " + name + " cannot be read; YUYV, NV12, MJPG, JPEG and GREY can");
  }
  if (layout.width_px <= 0 || layout.height_px <= 0 || !is_even) {
    return fail("pictures of " + std::to_string(layout.width_px) + "x" +
                std::to_string(layout.height_px) + " in " + name +
                " cannot be read; ask for another size");
  }
  if (exact.row_bytes == 0) exact.row_bytes = least_row_bytes;
  if (exact.row_bytes < least_row_bytes) {
    return fail("the driver says that a row of " + std::to_string(layout.width_px) + " pixels in " +
                name + " has " + std::to_string(layout.row_bytes) +
                " bytes, which cannot be; ask for another size");
  }
  std::unique_ptr<Jpeg> jpeg;
  if (is_jpeg(layout.fourcc)) {
    jpeg = std::make_unique<Jpeg>(exact, max_height_px);
    if (!jpeg->is_ready()) return fail("TurboJPEG does not start: no memory");
  }
  return PictureConverter(exact, std::move(jpeg));
}

PictureConverter::PictureConverter(const PixelLayout& layout, std::unique_ptr<Jpeg> jpeg)
    : layout_(layout), jpeg_(std::move(jpeg)) {}
PictureConverter::PictureConverter(PictureConverter&&) noexcept = default;
PictureConverter& PictureConverter::operator=(PictureConverter&&) noexcept = default;
PictureConverter::~PictureConverter() = default;

int PictureConverter::width_px() const {
  return jpeg_ ? jpeg_->scaled(layout_.width_px) : layout_.width_px;
}
int PictureConverter::height_px() const {
  return jpeg_ ? jpeg_->scaled(layout_.height_px) : layout_.height_px;
}

bool PictureConverter::convert(std::span<const std::uint8_t> bytes, cv::Mat& bgr) {
  if (jpeg_) return jpeg_->decode(bytes, bgr);
  const int width = layout_.width_px;
  const int height = layout_.height_px;
  const int row = layout_.row_bytes;
  // The padding of the last row may be missing.
  const auto needs = [&](std::size_t rows, int last_row_bytes) {
    return bytes.size() >=
           (rows - 1) * static_cast<std::size_t>(row) + static_cast<std::size_t>(last_row_bytes);
  };
  const auto rows = static_cast<std::size_t>(height);
  switch (layout_.fourcc) {
    case V4L2_PIX_FMT_YUYV:
      if (!needs(rows, 2 * width)) return false;
      cv::cvtColor(view(bytes, 0, height, width, CV_8UC2, row), bgr, cv::COLOR_YUV2BGR_YUY2);
      return true;
    case V4L2_PIX_FMT_NV12:
      if (!needs(rows + rows / 2, width)) return false;
      cv::cvtColorTwoPlane(
          view(bytes, 0, height, width, CV_8UC1, row),
          view(bytes, rows * static_cast<std::size_t>(row), height / 2, width / 2, CV_8UC2, row),
          bgr, cv::COLOR_YUV2BGR_NV12);
      return true;
    default:  // GREY: make() lets nothing else through
      if (!needs(rows, width)) return false;
      cv::cvtColor(view(bytes, 0, height, width, CV_8UC1, row), bgr, cv::COLOR_GRAY2BGR);
      return true;
  }
}

}  // namespace dance
