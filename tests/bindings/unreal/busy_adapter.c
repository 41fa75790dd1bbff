// libdance_adapter with a writer that is often faster: each third skeleton read is DANCE_BUSY. All
// other functions are the library's, which this one is linked with.
#include <dance_adapter.h>
#include <dlfcn.h>
#include <stddef.h>

typedef dance_status skeleton_function(dance_adapter*, uint32_t, dance_skeleton*);

dance_status dance_adapter_skeleton(dance_adapter* adapter, uint32_t slot, dance_skeleton* out) {
  static skeleton_function* real = NULL;
  static unsigned reads = 0;
  if (!real) {
    void* library = dlopen("libdance_adapter.so.1", RTLD_NOW | RTLD_NOLOAD);
    if (!library) return DANCE_NO_HOUSE;
    *(void**)&real = dlsym(library, "dance_adapter_skeleton");
  }
  return ++reads % 3 == 0 ? DANCE_BUSY : real(adapter, slot, out);
}
