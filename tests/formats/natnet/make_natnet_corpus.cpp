// Writes the corpus of the fuzz target: argument 1 is the folder.
#include <fstream>
#include <string>

#include "tests/formats/natnet/natnet_figure.h"
#include "tests/formats/natnet/natnet_packets.h"

int main(int argc, char** argv) {
  using namespace dance;
  if (argc != 2) return 2;
  const std::string folder = argv[1];
  FigureFrame figure;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    figure.put(static_cast<Bone>(b), Eigen::Vector3f(0.01f * static_cast<float>(b), 1.0f, 0.0f),
               Eigen::Quaternionf::Identity());
  auto models = std::make_unique<NatNetModels>();
  (void)models->skeletons.try_push(natnet_model(figure, "Ana", 1));
  auto frame = std::make_unique<NatNetFrame>();
  (void)frame->skeletons.try_push(natnet_skeleton(figure, 1, false));
  frame->rigid_bodies = 1;
  frame->models_changed = true;
  const auto save = [&](const std::string& name, char version, std::vector<std::uint8_t> bytes) {
    std::ofstream file(folder + "/" + name, std::ios::binary);
    file << version << std::string(bytes.begin(), bytes.end());
  };
  save("frame_3.1", 1, natnet_frame_packet({3, 1}, *frame));
  save("frame_4.1", 3, natnet_frame_packet({4, 1}, *frame));
  save("models_3.1", 1, natnet_models_packet({3, 1}, *models));
  save("models_4.1", 3, natnet_models_packet({4, 1}, *models));
  save("server", 1, natnet_server_packet({3, 1}, 10'000'000));
  return 0;
}
