#include "producers/camera/people/network_vision.h"

#include <cmath>
#include <utility>

namespace dance {
Result<std::unique_ptr<NetworkVision>> NetworkVision::open(const EstimatorOptions& options) {
  DANCE_TRY(PoseNetworks networks, open_networks(options));
  return std::unique_ptr<NetworkVision>(new NetworkVision(
      std::move(networks.detector), std::move(networks.landmarks), options.least_score));
}

std::span<const SeenPerson> NetworkVision::find(std::span<const SeenBody* const> without) {
  mask_.begin(detector_.look(picture_), PersonDetector::kSide_px);
  for (const SeenBody* body : without) mask_.add(*body);
  mask_.paint_over(detector_.input());
  return detector_.find_looked(least_score_);
}

bool NetworkVision::read(const BodyRegion& region, const OtherPeople& others, ReadBody& out) {
  network_.look(picture_, region);
  mask_.begin(region);
  for (const SeenBody* other : others.behind) mask_.add(*other);
  if (others.own && !others.behind.empty()) mask_.spare(*others.own);
  for (const SeenBody* other : others.before) mask_.add(*other);
  mask_.paint_over(network_.input());
  if (!network_.run() || !network_.read(out.body)) return false;
  out.is_covered.reset();
  if (others.before.empty()) return true;
  if (!others.behind.empty()) {
    mask_.begin(region);
    for (const SeenBody* other : others.before) mask_.add(*other);
  }
  for (std::size_t i = 0; i < kLandmarkCount; ++i)
    out.is_covered[i] = mask_.covers(out.body.image_px[i].head<2>());
  return true;
}

std::optional<PictureColour> NetworkVision::colour(const Eigen::Vector2f& place_px) {
  if (!(std::abs(place_px.x()) < 1e6f) || !(std::abs(place_px.y()) < 1e6f)) return std::nullopt;
  const int x = static_cast<int>(std::floor(place_px.x())),
            y = static_cast<int>(std::floor(place_px.y()));
  if (x < 0 || y < 0 || x >= picture_.cols || y >= picture_.rows) return std::nullopt;
  const auto& pixel = picture_.at<cv::Vec3b>(y, x);
  const float blue = static_cast<float>(pixel[0]) / 255.0f,
              green = static_cast<float>(pixel[1]) / 255.0f,
              red = static_cast<float>(pixel[2]) / 255.0f;
  const float luma = 0.299f * red + 0.587f * green + 0.114f * blue;
  return PictureColour(luma, 0.5f + 0.564f * (blue - luma), 0.5f + 0.713f * (red - luma));
}

}  // namespace dance
