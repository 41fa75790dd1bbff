#include "viewer/stage/figure_store.h"

namespace dance {
namespace {

// A guest who comes and goes, and the stages of one picture that are drawn one after the other.
constexpr std::uint64_t kPicturesKept = 240;
constexpr FigureLimits kUsual{};
constexpr FigureLimits kSmall{.most_picture_px = 256, .is_coarse = true};

}  // namespace

void FigureStore::begin_picture() {
  ++picture_;
  // There may be room by now.
  if (picture_ % kPicturesKept == 0)
    std::erase_if(entries_, [](const auto& entry) { return entry.second.gpu == nullptr; });
  free_unused(picture_ > kPicturesKept ? picture_ - kPicturesKept : 0);
}

void FigureStore::free_unused(std::uint64_t since) {
  for (auto it = entries_.begin(); it != entries_.end();) {
    if (!it->first.expired() && it->second.last_used >= since) {
      ++it;
      continue;
    }
    if (it->second.gpu) bytes_ -= it->second.gpu->bytes();
    it = entries_.erase(it);
  }
}

const FigureGpu* FigureStore::find(const std::shared_ptr<const AvatarModel>& model) {
  auto found = entries_.find(model);
  if (found == entries_.end()) {
    const auto mesh = maker_.take(model);
    if (mesh == nullptr) return nullptr;
    found = entries_.emplace(model, Entry{bring(*model, *mesh), picture_}).first;
  }
  found->second.last_used = picture_;
  return found->second.gpu.get();
}

std::unique_ptr<FigureGpu> FigureStore::bring(const AvatarModel& model, const FigureMesh& mesh) {
  if (mesh.levels.back().triangle_count == 0) return nullptr;
  FigureLimits limits = kUsual;
  // What this picture does not use gives way first.
  if (!fits(gpu_bytes(model, mesh, limits))) free_unused(picture_);
  if (!fits(gpu_bytes(model, mesh, limits))) limits = kSmall;
  if (!fits(gpu_bytes(model, mesh, limits))) {
    ++left_out_;
    return nullptr;
  }
  auto gpu = std::make_unique<FigureGpu>(model, mesh, limits);
  bytes_ += gpu->bytes();
  return gpu;
}

}  // namespace dance
