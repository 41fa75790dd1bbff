// MeshMaker: builds the meshes of models beside the drawing, so that a dancer who comes does not
// stop the picture; or at once, for pictures in files.
//
// Units/frames: none.
// Ownership:    owns its thread, from the first model on until it is destroyed; shares the models
//               that wait.
// Threads:      one owner; builds in a thread of its own.
// Failure:      none.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "viewer/mesh/figure_mesh.h"

namespace dance {

class MeshMaker {
 public:
  enum class When { kAtOnce, kBeside };

  MeshMaker() = default;
  ~MeshMaker();
  MeshMaker(const MeshMaker&) = delete;
  MeshMaker& operator=(const MeshMaker&) = delete;

  void set_when(When when) { when_ = when; }
  When when() const { return when_; }
  // The mesh once it is built, given once; before, null: ask again with the next picture.
  std::shared_ptr<const FigureMesh> take(const std::shared_ptr<const AvatarModel>& model);

 private:
  using Model = std::shared_ptr<const AvatarModel>;
  void build();

  When when_ = When::kAtOnce;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Model> waiting_;
  // Null while it is being built. The model is kept, so that no other comes to its place.
  std::map<Model, std::shared_ptr<const FigureMesh>> meshes_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace dance
