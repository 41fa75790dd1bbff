#include "viewer/window/own_figures.h"

namespace dance {

std::vector<NamedFigure> figures_of(const AvatarStore& store, const std::string& shipped_folder) {
  std::vector<NamedFigure> figures;
  for (const std::string& name : shipped_avatars(shipped_folder)) figures.push_back({name, name});
  std::size_t stored = 0;
  for (const StoredAvatar& it : store.list()) {
    if (!it.is_own || stored++ >= kMostStoredFigures) continue;
    figures.push_back({it.path, ""});
  }
  return figures;
}

}  // namespace dance
