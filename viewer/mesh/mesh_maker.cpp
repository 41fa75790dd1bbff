#include "viewer/mesh/mesh_maker.h"

#include <utility>

namespace dance {

MeshMaker::~MeshMaker() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<const FigureMesh> MeshMaker::take(const Model& model) {
  if (when_ == When::kAtOnce) return figure_mesh(*model);
  const std::lock_guard lock(mutex_);
  if (!thread_.joinable()) thread_ = std::thread([this] { build(); });
  // What was built for guests who have gone.
  std::erase_if(meshes_, [](const auto& built) {
    return built.second != nullptr && built.first.use_count() == 1;
  });
  const auto [found, is_new] = meshes_.try_emplace(model, nullptr);
  if (is_new) {
    waiting_.push_back(model);
    changed_.notify_one();
    return nullptr;
  }
  if (found->second == nullptr) return nullptr;
  auto mesh = std::move(found->second);
  meshes_.erase(found);
  return mesh;
}

void MeshMaker::build() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
    if (is_over_) return;
    const Model model = waiting_.front();
    waiting_.pop_front();
    if (model.use_count() <= 2) {  // its guest has gone: only this list and we have it
      meshes_.erase(model);
      continue;
    }
    lock.unlock();
    auto mesh = figure_mesh(*model);
    lock.lock();
    meshes_[model] = std::move(mesh);
  }
}

}  // namespace dance
