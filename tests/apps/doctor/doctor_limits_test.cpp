#include "apps/doctor/doctor_limits.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dance {
namespace {

using Grade = Finding::Grade;

TEST(DoctorLimits, NotesADiskThatIsNearlyFullWithItsFolder) {
  EXPECT_EQ(check_disk("/home/ann", 80'000'000'000).grade, Grade::kOk);
  EXPECT_EQ(check_disk("/home/ann", 80'000'000'000).what, "80.0 GB free at /home/ann");
  const Finding full = check_disk("/home/ann", 350'000'000);
  EXPECT_EQ(full.grade, Grade::kNote);
  EXPECT_TRUE(full.what.starts_with("0.3 GB free at /home/ann")) << full.what;
  EXPECT_NE(full.cure.find("du -xh /home/ann"), std::string::npos) << full.cure;
}

TEST(DoctorLimits, NotesALowLimitOfOpenFilesAndWhoMayRaiseIt) {
  EXPECT_EQ(check_open_files(1024, 1'048'576).grade, Grade::kOk);
  const Finding low = check_open_files(64, 1'048'576);
  EXPECT_EQ(low.grade, Grade::kNote);
  EXPECT_TRUE(low.what.starts_with("64 for each program")) << low.what;
  EXPECT_EQ(low.cure, "ulimit -n 4096");
  EXPECT_EQ(check_open_files(64, 256).cure, "ulimit -n 256");
  EXPECT_NE(check_open_files(64, 64).cure.find("limits.conf"), std::string::npos);
}

TEST(DoctorLimits, LooksAtTheDisksAndTheLimitOfThisMachine) {
  const auto findings = examine_limits();
  ASSERT_GE(findings.size(), 2u);
  EXPECT_EQ(findings.front().name, "disk");
  EXPECT_EQ(findings.back().name, "open files");
  EXPECT_TRUE(std::all_of(findings.begin(), findings.end(), [](const Finding& each) {
    return each.cure.empty() == (each.grade == Grade::kOk);
  }));
}

}  // namespace
}  // namespace dance
