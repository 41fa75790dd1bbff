#include "producers/camera/people/people_estimator.h"

#include <utility>

namespace dance {

Result<std::unique_ptr<PeopleEstimator>> PeopleEstimator::open(const EstimatorOptions& networks,
                                                               const PeopleOptions& people) {
  if (people.people < 1 || people.people > kMostDancers)
    return fail("one camera sees 1 to " + std::to_string(kMostDancers) + " dancers");
  DANCE_TRY(auto vision, NetworkVision::open(networks));
  return std::unique_ptr<PeopleEstimator>(new PeopleEstimator(std::move(vision), people));
}

std::span<const BodyLandmarks> PeopleEstimator::estimate(const Frame& frame,
                                                         const PeopleTracker::Reads& reads) {
  const std::span<BodyLandmarks> all(landmarks_.data(), tracker_.people());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!reads[i]) continue;
    all[i].found = all[i].is_new = false;
    all[i].presence = 0.0f;
    all[i].capture_time = frame.capture_time;
  }
  if (frame.image.type() != CV_8UC3 || frame.image.empty()) return all;
  if (frame.image.size() != picture_size_) tracker_.reset();
  picture_size_ = frame.image.size();
  vision_->look_at(frame.image);
  const auto people = tracker_.update(*vision_, frame.capture_time, reads);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PersonInPicture& person = people[i];
    if (!person.is_found) continue;
    BodyLandmarks& out = all[i];
    out.found = true;
    out.is_new = person.is_new;
    out.presence = person.body.presence;
    out.region = person.region;
    write_points(person.body, out);
  }
  return all;
}

}  // namespace dance
