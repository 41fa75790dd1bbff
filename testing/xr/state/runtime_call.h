// XrCall: what each function of the OpenXR test runtime begins with: the lock, the script's events
// that are due, errors that the script wants, and the checks of what an application hands in.
//
// Units/frames: none.
// Ownership:    holds the runtime's lock while it lives.
// Threads:      any.
// Failure:      wrong() records a misuse and returns the error that the application gets.
#pragma once

#include <initializer_list>
#include <mutex>
#include <optional>
#include <string>

#include "testing/xr/state/runtime_state.h"

namespace dance::test_xr {

class XrCall {
 public:
  explicit XrCall(const char* function);
  // An error that has nothing to do with the application: of the script, or a lost instance. To be
  // returned before anything else.
  const std::optional<XrResult>& early() const { return early_; }
  XrResult wrong(XrResult result, const std::string& reason) const;
  void misuse(const std::string& reason) const;
  std::unique_lock<std::mutex>& lock() { return lock_; }
  const char* function() const { return function_; }

  // Null where the handle is not alive (a misuse) or the session is lost: then result() says why.
  Session* session(XrSession handle);
  XrResult result() const { return result_; }
  void set_result(XrResult result) { result_ = result; }
  bool has_instance(XrInstance handle);
  bool has_extension(const char* name);
  // The type and what may hang on a structure.
  bool is_fine(const void* structure, XrStructureType type,
               std::initializer_list<XrStructureType> may_follow = {});
  bool is_fine_pose(const XrPosef& pose, const char* what);
  bool is_fine_time(XrTime time);

 private:
  const char* function_;
  std::unique_lock<std::mutex> lock_;
  std::optional<XrResult> early_;
  XrResult result_ = XR_SUCCESS;
};

// OpenXR's way to return a list: the count, and as many as asked for.
template <class T, class List>
XrResult give_list(XrCall& call, const List& list, std::uint32_t capacity, std::uint32_t* count,
                   T* into) {
  if (!count) return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no place for the count");
  *count = static_cast<std::uint32_t>(list.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < list.size())
    return call.wrong(XR_ERROR_SIZE_INSUFFICIENT, "the capacity is too small");
  if (!into) return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no place for the list");
  std::uint32_t i = 0;
  for (const auto& element : list) into[i++] = element;
  return XR_SUCCESS;
}
XrResult give_text(XrCall& call, const std::string& text, std::uint32_t capacity,
                   std::uint32_t* count, char* into);

// A structure that hangs on another, or null.
template <class T>
T* find_next(void* structure, XrStructureType type) {
  auto* base = static_cast<XrBaseOutStructure*>(structure);
  for (; base; base = base->next)
    if (base->type == type) return reinterpret_cast<T*>(base);
  return nullptr;
}

std::string text_of(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace dance::test_xr
