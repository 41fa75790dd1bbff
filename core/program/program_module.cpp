#include "core/program/program_module.h"

#include <dlfcn.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/printable.h"
#include "core/program/program.h"

namespace dance {

std::string module_path(const std::string& file) {
  const auto prefix = std::filesystem::path(program_folder()).parent_path();
  // Never relative to the current folder.
  return prefix.is_absolute() ? (prefix / "lib/dancegraph" / file).string() : std::string();
}

Result<const void*> load_module(const std::string& path, const ProgramModule& module) {
  const std::string needed = std::string(module.library) + " is needed and ";
  if (::access(path.c_str(), R_OK) != 0) return fail(needed + "not here: " + module.cure);
  void* const file = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (file == nullptr)
    return fail(needed + "cannot be loaded (" + printable(::dlerror()) + "): " + module.cure);
  using Entry = const void* (*)(const char* interface_hash);
  const auto entry = reinterpret_cast<Entry>(::dlsym(file, module.entry));
  const void* const table = entry != nullptr ? entry(module.interface_hash) : nullptr;
  if (table == nullptr) {
    ::dlclose(file);
    return fail(path + " is of another version than this program; install dancegraph and " +
                module.package + " of the same version, or build all again");
  }
  return table;
}

}  // namespace dance
