#include "research/predict/palm_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPalmFitRounds = 6;
// Of the sum of the moments' weights; columns are of one size on average.
constexpr double kPalmFitRidge = 1e-3;
// Errors count by their distance, those below as squares.
constexpr double kPalmFitSquare_m = 0.01;
constexpr double kHeldCounts = 3.0;
constexpr std::size_t kLeastMomentsAWeight = 10;

struct Column {
  std::size_t guess, sign;
};

std::vector<Column> weighed_columns() {
  std::vector<Column> columns;
  for (std::size_t g = 0; g < kPalmGuesses; ++g)
    for (std::size_t s = 0; s < kPalmSigns; ++s)
      if (is_palm_sign_weighed(static_cast<PalmGuess>(g), static_cast<PalmSign>(s)))
        columns.push_back({g, s});
  return columns;
}

// What each weight adds to the palm's place: three rows.
void rows_of(const PalmGuesses& said, const std::vector<Column>& columns, MatrixXd& rows) {
  rows.setZero(3, static_cast<Eigen::Index>(columns.size()));
  for (const PalmGuesses::ByPalm& by : said.by) {
    if (by.share <= 0.0f) continue;
    for (std::size_t c = 0; c < columns.size(); ++c)
      rows.col(static_cast<Eigen::Index>(c)) +=
          (by.share * by.signs[columns[c].sign] * by.guesses_m[columns[c].guess]).cast<double>();
  }
}

// How much each moment counts: horizons alike, though errors grow with them.
std::vector<double> counts_of(const std::vector<PalmMoment>& moments) {
  std::vector<double> missing_m, held;
  for (const PalmMoment& moment : moments) {
    if (moment.horizon >= held.size()) {
      missing_m.resize(moment.horizon + 1);
      held.resize(moment.horizon + 1);
    }
    if (!moment.is_held) continue;
    missing_m[moment.horizon] += static_cast<double>(moment.missing_m.norm());
    held[moment.horizon] += 1.0;
  }
  std::vector<double> counts;
  for (const PalmMoment& moment : moments) {
    const double missing = missing_m[moment.horizon];
    const double usual = missing > 0.0 ? held[moment.horizon] / missing : 0.0;
    counts.push_back(static_cast<double>(moment.said.near) * (moment.is_held ? kHeldCounts : 1.0) *
                     usual);
  }
  return counts;
}

}  // namespace

Result<PalmWeights> fit_palms(const std::vector<PalmMoment>& moments) {
  const std::vector<Column> columns = weighed_columns();
  const auto size = static_cast<Eigen::Index>(columns.size());
  const std::vector<double> counts = counts_of(moments);
  const auto counting = static_cast<std::size_t>(
      std::count_if(counts.begin(), counts.end(), [](double count) { return count > 0.0; }));
  if (counting < kLeastMomentsAWeight * columns.size())
    return fail(
        fmt::format("palms were in reach at {} moments, {} at least are needed to fit "
                    "weights to",
                    counting, kLeastMomentsAWeight * columns.size()));
  MatrixXd rows;
  VectorXd scale = VectorXd::Zero(size);
  for (std::size_t m = 0; m < moments.size(); ++m) {
    if (counts[m] <= 0.0) continue;
    rows_of(moments[m].said, columns, rows);
    scale += rows.colwise().squaredNorm().transpose();
  }
  scale = (scale / static_cast<double>(counting)).cwiseSqrt().cwiseMax(1e-9).cwiseInverse();
  VectorXd fitted = VectorXd::Zero(size);
  for (int round = 0; round < kPalmFitRounds; ++round) {
    MatrixXd A = MatrixXd::Zero(size, size);
    VectorXd b = VectorXd::Zero(size);
    double sum = 0.0;
    for (std::size_t m = 0; m < moments.size(); ++m) {
      if (counts[m] <= 0.0) continue;
      rows_of(moments[m].said, columns, rows);
      rows *= scale.asDiagonal();
      const Eigen::Vector3d missing = moments[m].missing_m.cast<double>();
      const double error_m = round == 0 ? 1.0 : (rows * fitted - missing).norm();
      const double weight = counts[m] / std::max(error_m, kPalmFitSquare_m);
      A.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose(), weight);
      b += weight * (rows.transpose() * missing);
      sum += weight;
    }
    A.diagonal().array() += kPalmFitRidge * sum;
    fitted = A.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  }
  PalmWeights weights{};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    weights[columns[c].guess][columns[c].sign] = static_cast<float>(fitted[i] * scale[i]);
  }
  return weights;
}

std::string palm_weights_text(const PalmWeights& weights) {
  std::string text;
  for (const auto& signs : weights) {
    std::string row;
    for (const float weight : signs) {
      const std::string number = fmt::format("{:.3f}f", weight);
      row += (row.empty() ? "" : ", ") + (number == "-0.000f" ? "0.000f" : number);
    }
    text += "    {{" + row + "}},\n";
  }
  return text;
}

}  // namespace dance
