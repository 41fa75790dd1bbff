#include <Eigen/Dense>
#include <cmath>

#include "core/codec/lattice/body_predictor.h"
#include "research/codec/codec_training.h"
#include "research/in_two_threads.h"

namespace dance {
namespace {

constexpr int kF = static_cast<int>(kMeanFeatures);
using Matrix = Eigen::Matrix<double, kF, kF>;
using Vector = Eigen::Matrix<double, kF, 1>;
constexpr std::size_t kLevel = 3;  // 1 mm: what it is trained for

struct Sums {
  Matrix A = Matrix::Zero();
  Vector b = Vector::Zero();
  double weight = 0.0;
  void add(const Sums& other) {
    A += other.A;
    b += other.b;
    weight += other.weight;
  }
};

// Least squares drawn towards `prior`, by so much of what each feature amounts to.
Vector solve(const Sums& sums, const Vector& scale, const Vector& prior, double pull) {
  Matrix A = sums.A;
  Vector b = sums.b;
  for (int i = 0; i < kF; ++i) {
    const double ridge = pull * (scale[i] + 1e-3);
    A(i, i) += ridge;
    b[i] += ridge * prior[i];
  }
  return A.ldlt().solve(b);
}

// Calls on_coordinate(c, predictor, y, n) for every coordinate of every frame: y steps from the
// reference, n in all.
template <class OnCoordinate>
void walk(const PoseModel& model, const std::vector<TakeLattice>& takes,
          const std::vector<DecodedTake>& decoded, const ReferenceCase& which,
          OnCoordinate on_coordinate) {
  for (std::size_t k = 0; k < takes.size(); ++k) {
    const BodyLattice& lattice = *takes[k].lattice;
    const DecodedTake& states = decoded[k];
    for (std::size_t i = which.age + which.run - 1u; i < states.size(); ++i) {
      std::array<const ReferenceBody*, 4> references{};
      for (std::size_t r = 0; r < which.run; ++r) references[r] = &states[i - which.age - r];
      BodyPredictor predictor(lattice, model, kLevel, which.slow != 0, which.age,
                              {references.data(), which.run});
      LatticeBodyState body{states[i]};
      for (std::size_t c = 0; c < kCoordinateCount; ++c) {
        if (c >= 3 && c % 3 == 0) lattice.seat_bone(c / 3 - 1, body);
        predictor.predict(c, body);
        double n = states[i].x[c] / lattice.step(c, kLevel);
        if (const double turn = lattice.turn(c, kLevel); turn > 0.0)
          n += turn * std::round((predictor.mean() - n) / turn);
        on_coordinate(c, predictor, n - predictor.features().base, n);
        predictor.decoded(c, n);
        if (c >= 3 && c % 3 == 2) lattice.place_bone(c / 3 - 1, body);
      }
    }
  }
}

void fit_means(PoseModel& model, const std::vector<TakeLattice>& takes,
               const std::vector<DecodedTake>& decoded, const ReferenceCase& which) {
  std::vector<std::array<Sums, kSpeeds>> sums(kCoordinateCount);
  walk(model, takes, decoded, which,
       [&](std::size_t c, const BodyPredictor& predictor, double y, double n) {
         const Features& f = predictor.features();
         const Vector x =
             Eigen::Map<const Eigen::Matrix<float, kF, 1>>(f.mean.data()).cast<double>();
         // What is far off, or was expected to be, says little.
         const double s = std::exp2(predictor.log2_spread());
         const double off = std::abs(n - predictor.mean());
         const double weight = 1.0 / ((s * s + 0.05) * (1.0 + off / (4.0 * s + 0.2)));
         Sums& into = sums[c][f.speed];
         into.A.noalias() += weight * x * x.transpose();
         into.b.noalias() += weight * y * x;
         into.weight += weight;
       });
  auto& coordinates = model.coordinates[case_index(which.slow != 0, which.age, which.run)];
  for (std::size_t c = 0; c < kCoordinateCount; ++c) {
    Sums all;
    for (const Sums& s : sums[c]) all.add(s);
    const Vector scale = all.A.diagonal() / std::max(all.weight, 1e-9);
    const Vector w = solve(all, scale, Vector::Zero(), 1e-3 * all.weight + 1.0);
    for (std::size_t speed = 0; speed < kSpeeds; ++speed) {
      const Vector own = solve(sums[c][speed], scale, w, 0.01 * all.weight + 1.0);
      for (int i = 0; i < kF; ++i)
        coordinates[c].mean[speed][static_cast<std::size_t>(i)] = static_cast<float>(own[i]);
    }
  }
}

void fit_spreads(PoseModel& model, const std::vector<TakeLattice>& takes,
                 const std::vector<DecodedTake>& decoded, const ReferenceCase& which) {
  std::vector<std::vector<float>> rows(kCoordinateCount);
  walk(model, takes, decoded, which,
       [&](std::size_t c, const BodyPredictor& predictor, double, double n) {
         for (const float x : predictor.features().spread) rows[c].push_back(x);
         rows[c].push_back(static_cast<float>(n - predictor.mean()));
       });
  auto& coordinates = model.coordinates[case_index(which.slow != 0, which.age, which.run)];
  in_two_threads(kCoordinateCount,
                 [&](std::size_t c) { fit_spread(coordinates[c].spread, rows[c]); });
}

}  // namespace

void fit_case(PoseModel& model, const std::vector<TakeLattice>& takes,
              const std::vector<DecodedTake>& decoded, const ReferenceCase& which) {
  // Twice, as later coordinates look at what earlier ones leave.
  for (int i = 0; i < 2; ++i) fit_means(model, takes, decoded, which);
  for (int i = 0; i < 2; ++i) fit_spreads(model, takes, decoded, which);
}

}  // namespace dance
