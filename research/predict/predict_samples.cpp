#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/pose/kinematics.h"
#include "research/predict/predict_training.h"
#include "transformers/predict/blend/moment_predictions.h"
#include "transformers/predict/past/dance_memory.h"
#include "transformers/predict/past/motion_bounds.h"
#include "transformers/predict/past/steady_rows.h"

namespace dance {
namespace {

using Matrix = Eigen::MatrixXf;

// Rows beyond the first this many are asked for; what was before them is the network's history.
constexpr std::size_t kFirstRow = kNetHistory;

// A take's rows, one a frame.
std::vector<BodyRow> rows_of(const BodySpace& space, const std::vector<Pose>& poses,
                             std::vector<float>* tremble_rad) {
  SteadyRows steady(space);
  std::vector<BodyRow> rows;
  BodyRow row;
  for (const Pose& pose : poses) {
    steady.observe(pose);
    while (steady.next(row)) {
      rows.push_back(row);
      if (tremble_rad) tremble_rad->push_back(steady.tremble_rad());
    }
  }
  return rows;
}

// Rows of the past by their age, as net_inputs() asks for them.
struct RowsBack {
  const std::vector<BodyRow>& rows;
  std::size_t now;
  const BodyRow& operator()(std::size_t age) const { return rows[now - age]; }
};

}  // namespace

// Bones stand where they do in the mean, left and right alike; a bone's lever is how far its turn
// moves the joints behind it, as the root of the sum of their squared distances.
void fit_space(PredictModel& model, const std::vector<PredictTake>& takes) {
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    Eigen::Matrix4f moments = Eigen::Matrix4f::Zero();
    for (const PredictTake& take : takes) {
      const PredictTake other = mirrored(take);
      for (const auto* poses : {&take.poses, &other.poses})
        for (const Pose& pose : *poses) {
          const Eigen::Vector4f q = pose.R_PB[b].coeffs();
          moments += q * q.transpose();
        }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4f> solver(moments);
    Eigen::Vector4f q = solver.eigenvectors().col(3);
    if (q.w() < 0.0f) q = -q;
    model.centres[b] = Eigen::Quaternionf(q).normalized();
  }
  model.centres[0] = Eigen::Quaternionf::Identity();
  BodyFrames frames;
  forward_kinematics(takes.front().skeleton, Pose(), frames);
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    float squares = 0.0f;
    for (std::size_t j = b + 1; j < kBoneCount; ++j) {
      auto parent = static_cast<int>(j);
      while (parent > static_cast<int>(b)) parent = kBones[static_cast<std::size_t>(parent)].parent;
      if (parent == static_cast<int>(b))
        squares += (frames.p_WB_m[j] - frames.p_WB_m[b]).squaredNorm();
    }
    model.lever[b] = 0.02f + std::sqrt(squares);
  }
  // The whole body turns with the hips, but what is judged and seen is less how it leans.
  model.lever[0] = 0.3f;
  model.lever[kPlaceGroup] = 0.7f;
  model.lever[kHeadingGroup] = 0.4f;
}

void add_samples(const PredictModel& model, const PredictTake& take, double tremble_deg,
                 std::size_t every, Random& random, NetSamples& samples) {
  const BodySpace space(model.centres);
  std::vector<float> tremble_rad;
  const auto heard = rows_of(space, trembling(take.poses, tremble_deg, random), &tremble_rad);
  const auto danced = rows_of(space, take.poses, nullptr);
  const auto longest = static_cast<std::size_t>(kHorizonFrames[kHorizons - 1]);
  NetInputs inputs;
  for (std::size_t t = kFirstRow + random.below(every); t + longest < heard.size(); t += every) {
    net_inputs(RowsBack{heard, t}, tremble_rad[t], inputs);
    samples.inputs.insert(samples.inputs.end(), inputs.begin(), inputs.end());
    for (std::size_t h = 0; h < kHorizons; ++h) {
      BodyRow way = way_between(heard[t], danced[t + static_cast<std::size_t>(kHorizonFrames[h])]);
      bound_motion(h, way);
      for (std::size_t i = 0; i < kRowSize; ++i)
        samples.ways.push_back(way.v[i] * model.lever[i % kRowGroups]);
    }
    ++samples.count;
  }
}

// The principal ways, each horizon counted alike.
void fit_basis(PredictModel& model, const NetSamples& samples) {
  Eigen::Map<const Matrix> ways(samples.ways.data(), kWaySize,
                                static_cast<Eigen::Index>(samples.count));
  for (std::size_t h = 0; h < kHorizons; ++h) {
    const auto rows = ways.middleRows(static_cast<Eigen::Index>(h * kRowSize), kRowSize);
    model.horizon_scale[h] = std::sqrt(rows.squaredNorm() / static_cast<float>(samples.count));
  }
  Matrix moments = Matrix::Zero(kWaySize, kWaySize);
  moments.selfadjointView<Eigen::Lower>().rankUpdate(ways);
  for (Eigen::Index i = 0; i < moments.rows(); ++i)
    for (Eigen::Index j = 0; j < moments.cols(); ++j)
      moments(i, j) /= model.horizon_scale[static_cast<std::size_t>(i) / kRowSize] *
                       model.horizon_scale[static_cast<std::size_t>(j) / kRowSize];
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(moments);
  for (std::size_t k = 0; k < kNetAnswers; ++k) {
    const auto column = solver.eigenvectors().col(static_cast<Eigen::Index>(kWaySize - 1 - k));
    for (std::size_t h = 0; h < kHorizons; ++h)
      for (std::size_t i = 0; i < kRowSize; ++i)
        model.net.basis[(h * kNetAnswers + k) * kRowSize + i] =
            column(static_cast<Eigen::Index>(h * kRowSize + i)) * model.horizon_scale[h] /
            std::max(model.lever[i % kRowGroups], 1e-3f);
  }
}

}  // namespace dance
