// Writes the corpus of the fuzz target of .tflite files: make_tflite_corpus FOLDER. All of it is
// made here, nothing is anybody's network.
//
// Threads: one.
// Failure: exit 1 where the folder cannot be written to.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

#include "tests/producers/camera/estimator/tiny_network.h"

namespace {

bool write(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  return file.good();
}

// A vector that says it is longer than the file, of a field that is read as a list.
std::vector<std::uint8_t> endless_vector() {
  std::vector<std::uint8_t> bytes = dance::tiny_convolution_file();
  const auto* graph = dance::tflite::GetModel(bytes.data())->subgraphs()->Get(0);
  const auto* length = reinterpret_cast<const std::uint8_t*>(graph->operators());
  std::fill_n(bytes.begin() + (length - bytes.data()), 4, 0xff);
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_tflite_corpus FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = argv[1];
  const bool did_write = write(folder + "/every_operation", dance::tiny_network_file()) &&
                         write(folder + "/hand_operations", dance::tiny_hand_network_file()) &&
                         write(folder + "/convolution", dance::tiny_convolution_file()) &&
                         write(folder + "/endless_vector", endless_vector());
  if (!did_write) std::fprintf(stderr, "%s: cannot be written to\n", folder.c_str());
  return did_write ? 0 : 1;
}
