// Graphics drivers keep some memory of their own until the process ends, and are unloaded before
// leaks are looked for, so that it counts as lost. This pins what is loaded: the memory stays
// reachable through the driver's own globals, and leaks of ours are found as ever.
//
// Ownership: the libraries stay loaded until the process ends.
// Threads:   any; not while another thread unloads libraries.
// Failure:   none.
#pragma once

#include <dlfcn.h>
#include <link.h>

#include <string>
#include <vector>

namespace dance {

// Call it while an OpenGL context is there.
inline void keep_drivers_loaded() {
  dlopen("libGL.so.1", RTLD_LAZY);  // ImGui opens and closes it
  std::vector<std::string> files;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* list) {
        static_cast<std::vector<std::string>*>(list)->emplace_back(info->dlpi_name);
        return 0;
      },
      &files);
  for (const std::string& file : files)
    if (!file.empty()) dlopen(file.c_str(), RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
}

}  // namespace dance
