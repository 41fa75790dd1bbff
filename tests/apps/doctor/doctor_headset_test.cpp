#include "apps/doctor/doctor_headset.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "testing/scratch_folder.h"

namespace dance {
namespace {

Environment environment_of(std::map<std::string, std::string> values) {
  return [values = std::move(values)](const char* name) {
    const auto found = values.find(name);
    return found == values.end() ? std::string() : found->second;
  };
}

TEST(DoctorHeadset, LooksWhereTheLoaderDoes) {
  const auto own =
      openxr_manifests(environment_of({{"HOME", "/home/ann"}, {"XDG_CONFIG_DIRS", "/a:/b/c"}}));
  EXPECT_EQ(own,
            (std::vector<std::string>{
                "/home/ann/.config/openxr/1/active_runtime.json", "/a/openxr/1/active_runtime.json",
                "/b/c/openxr/1/active_runtime.json", "/etc/openxr/1/active_runtime.json"}));
  EXPECT_EQ(openxr_manifests(environment_of({{"XR_RUNTIME_JSON", "/x.json"}, {"HOME", "/h"}})),
            std::vector<std::string>{"/x.json"});
}

TEST(DoctorHeadset, TellsWhetherARuntimeIsActive) {
  const auto folder = ScratchFolder::make();
  ASSERT_TRUE(folder);
  const std::string config = (*folder)->file("config");
  const auto environment =
      environment_of({{"XDG_CONFIG_HOME", config}, {"XDG_CONFIG_DIRS", config}});
  const Finding none = check_headset(environment, true);
  EXPECT_EQ(none.grade, Finding::Grade::kNote);
  EXPECT_NE(none.cure.find("SteamVR"), std::string::npos);
  std::filesystem::create_directories(config + "/openxr/1");
  std::ofstream(config + "/openxr/1/active_runtime.json") << "{}";
  const Finding active = check_headset(environment, true);
  EXPECT_EQ(active.grade, Finding::Grade::kOk);
  EXPECT_NE(active.what.find(config), std::string::npos);
}

TEST(DoctorHeadset, SaysWhatIsWrongWithANamedManifestAndWithTheBuild) {
  const auto environment = environment_of({{"XR_RUNTIME_JSON", "/nowhere/at/all.json"}});
  EXPECT_NE(check_headset(environment, true).cure.find("unset XR_RUNTIME_JSON"), std::string::npos);
  EXPECT_NE(check_headset(environment, false).cure.find("./dance setup"), std::string::npos);
}

}  // namespace
}  // namespace dance
