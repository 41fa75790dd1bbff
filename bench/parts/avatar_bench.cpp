// What does it cost to read an avatar with all checks, beside tinygltf alone, which parses the file
// and decodes its pictures? Of the files in the folder that DANCE_AVATARS names.
#include <benchmark/benchmark.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core/store/folder_entries.h"
#include "formats/avatar/avatar_reader.h"

namespace dance {
namespace {

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

void tinygltf_alone(benchmark::State& state, const Bytes& bytes) {
  for (auto _ : state) {
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!parser.LoadBinaryFromMemory(&model, &error, &warning, bytes->data(),
                                     static_cast<unsigned int>(bytes->size())))
      state.SkipWithError("tinygltf cannot read it");
    benchmark::DoNotOptimize(model);
  }
}

void ours(benchmark::State& state, const Bytes& bytes) {
  std::size_t vertices = 0;
  for (auto _ : state) {
    auto avatar = read_avatar(*bytes);
    if (!avatar) return state.SkipWithError(avatar.error().what.c_str());
    vertices = avatar->model.vertices.size();
    benchmark::DoNotOptimize(avatar);
  }
  state.counters["vertices"] = static_cast<double>(vertices);
}

bool register_files() {
  const char* folder = std::getenv("DANCE_AVATARS");
  std::error_code none;
  if (!folder || !std::filesystem::is_directory(folder, none)) return false;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : folder_entries(folder, none))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".vrm")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& path : files) {
    std::ifstream in(path, std::ios::binary);
    const auto bytes = std::make_shared<const std::vector<std::uint8_t>>(
        std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    const std::string question = "avatar: " + path.stem().string();
    benchmark::RegisterBenchmark((question + "/baseline").c_str(), tinygltf_alone, bytes);
    benchmark::RegisterBenchmark((question + "/ours").c_str(), ours, bytes);
  }
  return true;
}
const bool kIsRegistered = register_files();

}  // namespace
}  // namespace dance
