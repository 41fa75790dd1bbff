#include "producers/xr/xr_result.h"

#include <openxr/openxr_reflection.h>

namespace dance {

std::string name_of(XrResult result) {
  switch (result) {
#define DANCE_XR_NAME(name, value) \
  case name:                       \
    return #name;
    XR_LIST_ENUM_XrResult(DANCE_XR_NAME)
#undef DANCE_XR_NAME
            default : return "error " +
                      std::to_string(static_cast<int>(result));
  }
}

Result<void> checked(XrResult result, const char* what) {
  if (XR_SUCCEEDED(result)) return {};
  return fail(std::string("the headset's runtime refuses ") + what + " (" + name_of(result) + ")");
}

}  // namespace dance
