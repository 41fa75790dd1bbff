// main() of every GoogleTest program. Beside what GoogleTest does, it lists the tests with their
// source files for CTest (--list_sources), and prints the processor time of each slow test.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstring>
#include <string_view>

namespace dance {
namespace {

// Faster tests get no line.
constexpr double kSlow_s = 0.5;

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// User and system time of this process and of the children that it has waited for.
double processor_time_s() {
  double sum_s = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    sum_s += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  return sum_s;
}

class ProcessorTimePrinter : public ::testing::EmptyTestEventListener {
  void OnTestStart(const ::testing::TestInfo&) override { start_s_ = processor_time_s(); }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    const double used_s = processor_time_s() - start_s_;
    if (used_s < kSlow_s) return;
    std::printf("[      CPU ] %s.%s %.1f s\n", test.test_suite_name(), test.name(), used_s);
    std::fflush(stdout);
  }

  double start_s_ = 0;
};

// One line a test that is not disabled: source file, TAB, suite, TAB, test.
void list_sources() {
  const ::testing::UnitTest& all = *::testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const ::testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const ::testing::TestInfo& test = *suite.GetTestInfo(j);
      const std::string_view name = test.name();
      if (name.starts_with("DISABLED_")) continue;
      std::printf("%s\t%s\t%s\n", test.file(), suite.name(), test.name());
    }
  }
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc == 2 && std::strcmp(argv[1], "--list_sources") == 0) {
    dance::list_sources();
    return 0;
  }
  ::testing::UnitTest::GetInstance()->listeners().Append(new dance::ProcessorTimePrinter);
  return RUN_ALL_TESTS();
}
