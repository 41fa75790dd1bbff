#include "viewer/window/own_figures.h"

#include <algorithm>
#include <filesystem>

namespace dance {

std::vector<NamedFigure> figures_of(const AvatarStore& store, const std::string& shipped_folder) {
  std::vector<NamedFigure> figures;
  std::error_code error;
  for (const auto& it : std::filesystem::directory_iterator(shipped_folder, error)) {
    const std::string name = it.path().stem().string();
    if (it.path().extension() == ".vrm" && GuestId::parse(name)) figures.push_back({name, name});
  }
  std::ranges::sort(figures, {}, &NamedFigure::name);
  std::size_t stored = 0;
  for (const StoredAvatar& it : store.list()) {
    if (!it.is_own || stored++ >= kMostStoredFigures) continue;
    figures.push_back({it.path, ""});
  }
  return figures;
}

}  // namespace dance
