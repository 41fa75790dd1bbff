// KeyMoments: pictures of the first camera in which the body had moved on: what the placement of
// another camera is estimated from. A dancer who stands still adds none.
//
// Units/frames: the first camera's stamps.
// Ownership:    a ring of kCapacity entries inside (about 130 KB); never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      none; the oldest is overwritten.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "producers/camera/multiview/view_points.h"

namespace dance {

class KeyMoments {
 public:
  static constexpr std::size_t kCapacity = 240;

  KeyMoments() : ring_(std::make_unique<std::array<ViewPoints, kCapacity>>()) {}
  // True where it was taken.
  bool add(const ViewPoints& points);
  void clear() { added_ = first_ = 0; }
  // Drops those before a time, as the other camera's history no longer has them.
  void drop_before(MonoTime time);

  // Entries are counted for ever: those from first() on, before added(), are there.
  std::uint64_t first() const { return first_; }
  std::uint64_t added() const { return added_; }
  std::size_t count() const { return static_cast<std::size_t>(added_ - first_); }
  const ViewPoints& entry(std::uint64_t number) const {
    return (*ring_)[static_cast<std::size_t>(number % kCapacity)];
  }

 private:
  std::unique_ptr<std::array<ViewPoints, kCapacity>> ring_;
  std::uint64_t first_ = 0;
  std::uint64_t added_ = 0;
};

}  // namespace dance
