#include "producers/camera/program/capture_chain.h"

#include <utility>

#include "core/base/assert.h"

namespace dance {

CaptureChain::CaptureChain(std::unique_ptr<LandmarkSource> source,
                           std::vector<std::unique_ptr<DancerCapture>> dancers)
    : source_(std::move(source)), dancers_(std::move(dancers)) {}

void CaptureChain::see(const Frame& frame, const cv::Mat* right) {
  ++pictures_;
  bodies_ = source_->see(frame);
  DANCE_ASSERT(bodies_.size() == dancers_.size(), bodies_.size(), dancers_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (!source_->is_left_out(i)) dancers_[i]->publish(frame, bodies_[i], right);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (!source_->is_left_out(i)) dancers_[i]->look_closer(frame, bodies_[i]);
}

void CaptureChain::restart() {
  source_->restart();
  for (const auto& dancer : dancers_) dancer->restart();
}

}  // namespace dance
