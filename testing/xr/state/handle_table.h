// HandleTable: what an application's handles stand for. A handle is a number that is never used
// again, so that one that outlives its object is found instead of followed.
//
// Units/frames: none.
// Ownership:    owns the objects.
// Threads:      none inside; the runtime's lock guards it.
// Failure:      find() of a handle that is not alive is null.
#pragma once

#include <openxr/openxr.h>

#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

namespace dance::test_xr {

template <class Handle, class Object>
class HandleTable {
 public:
  Handle add(std::unique_ptr<Object> object) {
    static std::uint64_t last = 0;
    last += 16;
    const std::uint64_t number = last + sizeof(Object) * 0x100000000u;  // the kinds' differ
    objects_.emplace(number, std::move(object));
    return std::bit_cast<Handle>(number);
  }
  Object* find(Handle handle) const {
    const auto found = objects_.find(std::bit_cast<std::uint64_t>(handle));
    return found == objects_.end() ? nullptr : found->second.get();
  }
  bool remove(Handle handle) { return objects_.erase(std::bit_cast<std::uint64_t>(handle)) > 0; }
  template <class Condition>
  void remove_if(Condition condition) {
    std::erase_if(objects_, [&](const auto& entry) { return condition(*entry.second); });
  }
  std::size_t size() const { return objects_.size(); }
  void clear() { objects_.clear(); }
  auto begin() const { return objects_.begin(); }
  auto end() const { return objects_.end(); }

 private:
  std::map<std::uint64_t, std::unique_ptr<Object>> objects_;
};

}  // namespace dance::test_xr
