#include "research/codec/codec_training.h"

#include <fmt/format.h>

#include "core/codec/lattice/lattice_codec.h"
#include "research/in_two_threads.h"

namespace dance {
namespace {

struct Decoded {
  DecodedTake states;
  double bytes = 0.0;
};

Decoded encode_take(const CodecTake& take, std::shared_ptr<const PoseModel> model,
                    std::uint32_t age) {
  LatticeEncoder encoder(std::move(model));
  encoder.set_skeleton(take.skeleton);
  encoder.refer_to_age(age);
  Decoded decoded;
  std::array<std::uint8_t, kMaxPosePayload> payload{};
  for (const Pose& pose : take.poses) {
    decoded.bytes += static_cast<double>(encoder.encode(pose, payload));
    if (encoder.newest() == nullptr) continue;
    decoded.states.push_back(encoder.newest()->body);
  }
  return decoded;
}

std::vector<TakeLattice> lattices_of(const std::vector<CodecTake>& takes, const RestModel& rest) {
  std::vector<TakeLattice> lattices;
  for (const CodecTake& take : takes)
    lattices.push_back({&take, std::make_unique<BodyLattice>(take.skeleton, rest)});
  return lattices;
}

// Bytes a frame of all takes, coded with references of this age, and their frames as decoded.
double encode_all(const std::vector<CodecTake>& takes, const PoseModel& model, std::uint32_t age,
                  std::vector<DecodedTake>& decoded) {
  const auto shared = std::make_shared<const PoseModel>(model);
  std::vector<Decoded> results(takes.size());
  in_two_threads(takes.size(),
                 [&](std::size_t i) { results[i] = encode_take(takes[i], shared, age); });
  double bytes = 0.0, frames = 0.0;
  decoded.clear();
  for (Decoded& result : results) {
    bytes += result.bytes;
    frames += static_cast<double>(result.states.size());
    decoded.push_back(std::move(result.states));
  }
  return bytes / frames;
}

void train_pace(PoseModel& model, const CodecTraining& training, bool slow) {
  const std::vector<CodecTake>& takes = slow ? training.slow : training.fast;
  const std::vector<TakeLattice> lattices = lattices_of(takes, model.rest);
  for (const std::uint8_t age : kModelAges) {
    std::vector<DecodedTake> decoded;
    double bytes = 0.0;
    for (int round = 0; round < training.rounds; ++round) {
      bytes = encode_all(takes, model, age, decoded);
      const ReferenceCase which{slow, age, 4};
      fit_case(model, lattices, decoded, which);
    }
    bytes = encode_all(takes, model, age, decoded);
    for (const std::uint8_t run : {std::uint8_t{1}, std::uint8_t{2}})
      fit_case(model, lattices, decoded, {slow, age, run});
    if (training.tell)
      training.tell(fmt::format("{} frames a second, reference {:2} old: {:.2f} bytes a frame",
                                slow ? 30 : 60, age, bytes));
  }
}

}  // namespace

Result<std::unique_ptr<PoseModel>> train_codec(const CodecTraining& training) {
  if (training.fast.empty()) return fail("there is nothing to train on: name BVH files");
  auto model = std::make_unique<PoseModel>(*generic_model());
  model->rest = find_rest(training.fast);
  model->intra = find_intra(lattices_of(training.fast, model->rest));
  model->intra_table = logistic_table(0.15);
  train_pace(*model, training, false);
  if (!training.slow.empty()) train_pace(*model, training, true);
  return model;
}

}  // namespace dance
