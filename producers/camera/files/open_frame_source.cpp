#include "producers/camera/files/open_frame_source.h"

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "producers/camera/files/image_reel.h"
#include "producers/camera/files/picture_file.h"
#include "producers/camera/files/video_reel.h"
#include "producers/camera/v4l2/v4l2_camera.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualImagesHz = 30.0;

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

// A name with a slash or an ending is meant as a file, also where there is none.
bool looks_like_a_file(const std::string& called) {
  return called.find('/') != std::string::npos || fs::path(called).has_extension();
}

std::vector<std::string> split_at_commas(const std::string& called) {
  std::vector<std::string> parts;
  std::istringstream stream(called);
  for (std::string part; std::getline(stream, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

Result<std::unique_ptr<FrameSource>> open_images(const std::vector<std::string>& called,
                                                 const SourceOptions& options) {
  DANCE_TRY(std::vector<std::string> paths, picture_files(called));
  std::string name = fs::path(called.front()).filename();
  if (name.empty()) name = called.front();
  if (called.size() > 1) name += " and " + std::to_string(called.size() - 1) + " more";
  const double hz = options.play.hz > 0.0 ? options.play.hz : kUsualImagesHz;
  DANCE_TRY(std::unique_ptr<ImageReel> reel, ImageReel::open(std::move(paths), name, hz));
  return std::make_unique<PlayedReel>(std::move(reel), options.play);
}

}  // namespace

Result<std::vector<std::string>> picture_files(const std::vector<std::string>& called) {
  std::vector<std::string> all;
  for (const std::string& one : called) {
    if (!is_folder(one)) {
      all.push_back(one);
      continue;
    }
    DANCE_TRY(const std::vector<std::string> files, pictures_in(one));
    all.insert(all.end(), files.begin(), files.end());
  }
  return all;
}

std::string line_on(const FrameSource& source) {
  if (const auto* camera = dynamic_cast<const V4l2Camera*>(&source)) return camera->negotiated();
  const FrameFormat& format = source.format();
  char rate[32];
  std::snprintf(rate, sizeof rate, "%.4g", format.hz);
  return source.name() + ": " + std::to_string(format.width_px) + "x" +
         std::to_string(format.height_px) + " " + format.encoding + " at " + rate + " Hz";
}

Result<std::unique_ptr<FrameSource>> open_frame_source(const std::string& called,
                                                       const SourceOptions& options) {
  const bool is_device = called.starts_with("/dev/");
  if (!is_device && !is_number(called) && is_there(called)) {
    if (is_folder(called) || is_picture(called)) return open_images({called}, options);
    DANCE_TRY(std::unique_ptr<VideoReel> reel, VideoReel::open(called));
    return std::make_unique<PlayedReel>(std::move(reel), options.play);
  }
  if (called.find(',') != std::string::npos) {
    const std::vector<std::string> parts = split_at_commas(called);
    if (parts.size() > 1) return open_images(parts, options);
  }
  if (!is_device && !is_number(called) && looks_like_a_file(called)) {
    return tl::make_unexpected(check_file(called).error());
  }
  DANCE_TRY(std::unique_ptr<V4l2Camera> camera, V4l2Camera::open(called, options.camera));
  return std::unique_ptr<FrameSource>(std::move(camera));
}

Result<std::unique_ptr<FrameSource>> open_frame_source(const std::vector<std::string>& called,
                                                       const SourceOptions& options) {
  if (called.empty()) return open_frame_source(std::string(), options);
  return called.size() == 1 ? open_frame_source(called.front(), options)
                            : open_images(called, options);
}

}  // namespace dance
