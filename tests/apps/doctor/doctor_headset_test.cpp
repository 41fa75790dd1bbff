#include "apps/doctor/doctor_headset.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "testing/scratch_folder.h"

namespace dance {
namespace {

openxr::Environment environment_of(std::map<std::string, std::string> values) {
  return [values = std::move(values)](const char* name) {
    const auto found = values.find(name);
    return found == values.end() ? std::string() : found->second;
  };
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
  std::ofstream(config + "/openxr/1/active_runtime.json")
      << R"({"runtime": {"library_path": "../../libruntime.so"}})";
  const Finding broken = check_headset(environment, true);
  EXPECT_EQ(broken.grade, Finding::Grade::kNote);
  EXPECT_NE(broken.what.find("library that is missing: " + config + "/libruntime.so"),
            std::string::npos)
      << broken.what;
  EXPECT_FALSE(broken.cure.empty());
  std::ofstream(config + "/libruntime.so") << "";
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
