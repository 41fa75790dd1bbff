#include "producers/camera/view/preview.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/net/mono_clock.h"
#include "producers/camera/files/bgr_picture.h"
#include "producers/camera/view/overlay.h"
#include "producers/camera/view/picture_window.h"

namespace dance {
namespace {

constexpr int kWidest_px = 640;
constexpr Duration kFileEvery = Duration::ms(200);

std::string ending_of(const std::string& file) {
  const std::size_t dot = file.rfind('.');
  return dot == std::string::npos ? "" : file.substr(dot);
}

// Mirrored, left and right stay the dancer's: only the places change.
void mirror(PreviewShot& shot) {
  cv::Mat& picture = shot.picture.pixels;
  cv::flip(picture, picture, 1);
  for (BodyLandmarks& body : shot.bodies)
    for (Eigen::Vector3f& point : body.image_px)
      point.x() = static_cast<float>(picture.cols - 1) - point.x();
}

}  // namespace

Result<std::unique_ptr<Preview>> Preview::open(const PreviewOptions& options) {
  std::unique_ptr<Preview> preview(new Preview(options));
  if (!options.file.empty()) {
    const std::string ending = ending_of(options.file);
    if (ending != ".jpg" && ending != ".png")
      return fail("--preview-file '" + options.file + "': name a .jpg or a .png");
    const cv::Mat black(120, 160, CV_8UC3, cv::Scalar::all(0));
    if (!preview->write_file(black)) return fail(preview->trouble_);
  }
  if (options.window) {
    // Tried here, so that what is missing is said before anything starts; the thread opens its own.
    auto trial = PictureWindow::open(options.title, kWidest_px, kWidest_px * 9 / 16);
    if (!trial) return tl::make_unexpected(trial.error());
  }
  preview->thread_ = std::thread([p = preview.get()] { p->run(); });
  return preview;
}

Preview::~Preview() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Preview::show(const Frame& frame, std::span<const BodyLandmarks> bodies,
                   std::string_view caption) {
  const double scale = std::min(1.0, static_cast<double>(kWidest_px) / frame.image.cols);
  cv::resize(frame.image, scratch_.picture.pixels, {}, scale, scale, cv::INTER_AREA);
  scratch_.body_count = std::min(bodies.size(), scratch_.bodies.size());
  for (std::size_t i = 0; i < scratch_.body_count; ++i) {
    BodyLandmarks& body = scratch_.bodies[i];
    body = bodies[i];
    for (Eigen::Vector3f& point : body.image_px) point *= static_cast<float>(scale);
    body.region.side_px *= static_cast<float>(scale);
  }
  const std::size_t length = std::min(caption.size(), scratch_.caption.size() - 1);
  std::copy_n(caption.begin(), length, scratch_.caption.begin());
  scratch_.caption[length] = '\0';
  shots_.put(scratch_);
}

void Preview::run() {
  try {
    draw_all();
  } catch (const cv::Exception&) {
    trouble_ = "the preview cannot be drawn; dance goes on without it";
    failed_ = true;
  }
}

void Preview::draw_all() {
  std::unique_ptr<PictureWindow> window;
  if (options_.window) {
    auto opened = PictureWindow::open(options_.title, kWidest_px, kWidest_px * 9 / 16);
    if (!opened) {
      trouble_ = opened.error().what;
      failed_ = true;
      return;
    }
    window = std::move(*opened);
  }
  MonoTime next_file;
  PreviewShot shot;
  while (!stop_) {
    if (window && !window->is_open()) {
      was_closed_ = true;
      return;
    }
    const PreviewShot* newest = shots_.take();
    if (!newest) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      continue;
    }
    shot = *newest;
    if (options_.is_mirrored) mirror(shot);
    cv::Mat& picture = shot.picture.pixels;
    for (std::size_t i = 0; i < shot.body_count; ++i) draw_landmarks(picture, shot.bodies[i]);
    draw_caption(picture, shot.caption.data());
    if (window) window->show(picture);
    const MonoTime now = mono_now();
    if (options_.file.empty() || now < next_file) continue;
    next_file = now + kFileEvery;
    if (!write_file(picture)) {
      failed_ = true;
      return;
    }
  }
}

// Readers of the file find a complete picture, the old one or the new.
bool Preview::write_file(const cv::Mat& picture) {
  const auto bytes =
      ending_of(options_.file) == ".png" ? png_of_bgr(picture) : jpeg_of_bgr(picture);
  if (!bytes) {
    trouble_ = "the preview cannot be drawn: " + bytes.error().what;
    return false;
  }
  const std::string next = options_.file + ".next";
  std::FILE* file = std::fopen(next.c_str(), "wb");
  bool fine = file && std::fwrite(bytes->data(), 1, bytes->size(), file) == bytes->size();
  if (file) fine = std::fclose(file) == 0 && fine;
  fine = fine && std::rename(next.c_str(), options_.file.c_str()) == 0;
  if (!fine)
    trouble_ = "the preview cannot be written to '" + options_.file +
               "'; is its folder there, and has the disk room?";
  return fine;
}

}  // namespace dance
