// FigureStore: the models that are on the graphics card: brought there when a guest comes with one,
// taken off when its last guest has gone, and never more than fits.
//
// Units/frames: bytes.
// Ownership:    owns what is on the card; keeps no model alive.
// Threads:      the one whose context is current; meshes are built in a thread of their own where
//               wanted (MeshMaker).
// Failure:      a model that does not fit is drawn coarsely, with small pictures; one that does not
//               fit even so is not drawn and counted in left_out().
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "viewer/mesh/mesh_maker.h"
#include "viewer/stage/figure_gpu.h"

namespace dance {

class FigureStore {
 public:
  explicit FigureStore(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  MeshMaker& maker() { return maker_; }
  void set_most_bytes(std::size_t most_bytes) { most_bytes_ = most_bytes; }

  // Once for each picture, before find(): frees what no picture has used lately.
  void begin_picture();
  // Null while the mesh is being built, or where there is no room.
  const FigureGpu* find(const std::shared_ptr<const AvatarModel>& model);

  std::size_t models() const { return entries_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t left_out() const { return left_out_; }

 private:
  using Model = std::weak_ptr<const AvatarModel>;
  struct Entry {
    std::unique_ptr<FigureGpu> gpu;  // null: no room for it
    std::uint64_t last_used = 0;
  };
  std::unique_ptr<FigureGpu> bring(const AvatarModel& model, const FigureMesh& mesh);
  void free_unused(std::uint64_t since);
  bool fits(std::size_t bytes) const { return bytes_ + bytes <= most_bytes_; }

  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::size_t left_out_ = 0;
  std::uint64_t picture_ = 0;
  MeshMaker maker_;
  std::map<Model, Entry, std::owner_less<Model>> entries_;
};

}  // namespace dance
