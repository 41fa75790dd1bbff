#include <numeric>

#include "research/beats/music_training.h"
#include "research/beats/net_fit.h"

namespace dance {
namespace {

NetMoments gather(const std::vector<const TrainingSong*>& songs,
                  LabelledMoments TrainingSong::*moments, int inputs) {
  NetMoments all;
  for (const TrainingSong* song : songs) {
    const LabelledMoments& of = song->*moments;
    all.classes.insert(all.classes.end(), of.classes.begin(), of.classes.end());
    for (const float w : of.weights) all.weights.push_back(w * song->weight);
  }
  all.inputs.resize(inputs, static_cast<Eigen::Index>(all.classes.size()));
  Eigen::Index column = 0;
  for (const TrainingSong* song : songs) {
    const LabelledMoments& of = song->*moments;
    const auto n = static_cast<Eigen::Index>(of.classes.size());
    all.inputs.middleCols(column, n) =
        Eigen::Map<const Eigen::MatrixXf>(of.features.data(), inputs, n);
    column += n;
  }
  const float sum = std::accumulate(all.weights.begin(), all.weights.end(), 0.0f);
  for (float& w : all.weights) w *= static_cast<float>(column) / sum;
  return all;
}

template <class Net>
Net fit(const std::vector<const TrainingSong*>& songs, LabelledMoments TrainingSong::*moments,
        const MusicTraining& training) {
  const FittedNet fitted = fit_net(gather(songs, moments, Net::kInputs),
                                   {Net::kInputs, Net::kHidden, Net::kAnswers}, training);
  Net net;
  net.in = fitted.in;
  net.in_bias = fitted.in_bias;
  net.out = fitted.out;
  net.out_bias = fitted.out_bias;
  return net;
}

}  // namespace

StrokeNet fit_stroke_net(const std::vector<const TrainingSong*>& songs,
                         const MusicTraining& training) {
  return fit<StrokeNet>(songs, &TrainingSong::strokes, training);
}

TempoNet fit_tempo_net(const std::vector<const TrainingSong*>& songs,
                       const MusicTraining& training) {
  return fit<TempoNet>(songs, &TrainingSong::tempi, training);
}

}  // namespace dance
