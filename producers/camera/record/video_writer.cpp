#include "producers/camera/record/video_writer.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <opencv2/videoio.hpp>

namespace dance {

VideoShot& VideoShot::operator=(const VideoShot& other) {
  if (this == &other) return *this;
  other.picture.copyTo(picture);
  capture_time = other.capture_time;
  return *this;
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
  scratch_.picture = frame.image;  // shares; put() copies the pixels
  scratch_.capture_time = frame.capture_time;
  shots_.put(scratch_);
  scratch_.picture.release();
}

// Matroska, so that what was written before a crash can be read; Motion JPEG, so that each picture stands for itself.
void VideoWriter::run() {
  cv::VideoWriter video;
  const auto end_with = [this](std::string why) {
    trouble_ = std::move(why);
    failed_ = true;
  };
  for (;;) {
    const bool is_last_look = stop_;
    const VideoShot* shot = shots_.take();
    if (!shot) {
      if (is_last_look) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    if (!video.isOpened()) {
      const int code = cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
      if (!video.open(path_, cv::CAP_FFMPEG, code, hz_, shot->picture.size()))
        return end_with("the video '" + path_ +
                        "' cannot be written; is its folder there, and has the disk room?");
    }
    video.write(shot->picture);
    const std::uint64_t number = written_++;
    if (std::fprintf(times_.get(), "%llu\t%lld\n", static_cast<unsigned long long>(number),
                     static_cast<long long>(shot->capture_time.since_zero_us())) < 0 ||
        std::fflush(times_.get()) != 0)
      return end_with("'" + path_ + ".tsv' cannot be written; has the disk room?");
  }
}

}  // namespace dance
