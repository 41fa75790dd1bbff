// Prints what Google Benchmark measured as ratios: benchmarks are named "question/variant", and
// each variant is divided by its question's "baseline", as absolute times belong to the machine
// they were taken on.
//
// Units/frames: nanoseconds of a run, as Google Benchmark gives them; ratios have none.
// Ownership:    plain values.
// Threads:      one.
// Failure:      a question without a baseline has no ratio.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace dance {

class RatioReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;
  // Of the same measurements, with the keys question, variant, ns, ratio and the benchmark's own
  // counters.
  std::string json() const;

 private:
  struct Row {
    std::string question;
    std::string variant;
    double ns = 0.0;  // median of the repetitions
    std::vector<std::pair<std::string, double>> counters;
  };
  double ratio_of(const Row& row) const;  // NaN without a baseline
  std::vector<Row> rows_;
};

}  // namespace dance
