#include "producers/camera/record/video_writer.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <opencv2/videoio.hpp>

namespace dance {
namespace {

// Of a camera that does not say.
constexpr double kUsualHz = 30.0;

std::string text_of(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

VideoWriter::VideoWriter(std::string path, double hz)
    : path_(std::move(path)), hz_(std::isfinite(hz) && hz > 0.0 ? hz : kUsualHz) {}

std::string VideoWriter::trouble() const {
  if (failed_) return trouble_;
  return other_size_ > 0 ? size_trouble_ : std::string();
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::create(const std::string& path, double hz) {
  std::unique_ptr<VideoWriter> writer(new VideoWriter(path, hz));
  const std::string table = path + ".tsv";
  writer->times_.reset(std::fopen(table.c_str(), "wx"));
  if (!writer->times_) return fail("'" + table + "' cannot be written: " + std::strerror(errno));
  std::fputs("picture\tcapture_us\n", writer->times_.get());
  writer->thread_ = std::thread([w = writer.get()] { w->run(); });
  return writer;
}

VideoWriter::~VideoWriter() { finish(); }

void VideoWriter::finish() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  times_.reset();
}

void VideoWriter::add(const Frame& frame) {
  scratch_.picture.pixels = frame.image;  // shares; put() copies the pixels
  scratch_.capture_time = frame.capture_time;
  shots_.put(scratch_);
  scratch_.picture.pixels.release();
}

void VideoWriter::end_with(std::string why) {
  trouble_ = std::move(why);
  failed_ = true;
}

void VideoWriter::run() {
  try {
    write_all();
  } catch (const cv::Exception& e) {
    end_with("the video '" + path_ + "' cannot be written: " + e.err);
  }
}

// Matroska, so that what was written before a crash can be read; Motion JPEG, so that each picture
// stands for itself.
void VideoWriter::write_all() {
  cv::VideoWriter video;
  cv::Size size;
  for (;;) {
    const bool is_last_look = stop_;
    const VideoShot* shot = shots_.take();
    if (!shot) {
      if (is_last_look) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    if (!video.isOpened()) {
      size = shot->picture.pixels.size();
      const int code = cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
      if (!video.open(path_, cv::CAP_FFMPEG, code, hz_, size))
        return end_with("the video '" + path_ +
                        "' cannot be written; is its folder there, and has the disk room?");
    }
    // A video has one size, and OpenCV drops others silently.
    if (shot->picture.pixels.size() != size) {
      if (other_size_ == 0)
        size_trouble_ = "the video '" + path_ + "' has pictures of " + text_of(size) +
                        "; those of " + text_of(shot->picture.pixels.size()) +
                        " are left out; record them into another folder";
      ++other_size_;
      continue;
    }
    video.write(shot->picture.pixels);
    const std::uint64_t number = written_++;
    if (std::fprintf(times_.get(), "%llu\t%lld\n", static_cast<unsigned long long>(number),
                     static_cast<long long>(shot->capture_time.since_zero_us())) < 0 ||
        std::fflush(times_.get()) != 0)
      return end_with("'" + path_ + ".tsv' cannot be written; has the disk room?");
  }
}

}  // namespace dance
