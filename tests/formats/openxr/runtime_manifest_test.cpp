#include "formats/openxr/runtime_manifest.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "tests/test_folder.h"

namespace dance::openxr {
namespace {

namespace fs = std::filesystem;

Environment environment_with(std::map<std::string, std::string> values) {
  return [values = std::move(values)](const char* name) {
    const auto found = values.find(name);
    return found == values.end() ? std::string() : found->second;
  };
}

class OpenxrManifest : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) const {
    const std::string path = folder_.path(name);
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path) << content;
    return path;
  }
  std::string manifest(const std::string& library) const {
    return file(
        "openxr/1/active_runtime.json",
        R"({"file_format_version": "1.0.0", "runtime": {"library_path": ")" + library + R"("}})");
  }
  static std::string error_of(const std::string& path) {
    const auto library = library_of(path);
    return library ? "it is fine: " + *library : library.error().what;
  }

  TestFolder folder_{"openxr-manifest"};
};

TEST_F(OpenxrManifest, IsSearchedWhereTheLoaderSearches) {
  EXPECT_EQ(
      manifest_paths(environment_with({{"HOME", "/home/ann"}, {"XDG_CONFIG_DIRS", "/a:/b/c"}})),
      (std::vector<std::string>{
          "/home/ann/.config/openxr/1/active_runtime.json", "/a/openxr/1/active_runtime.json",
          "/b/c/openxr/1/active_runtime.json", "/etc/openxr/1/active_runtime.json"}));
  EXPECT_EQ(manifest_paths(environment_with({{"XR_RUNTIME_JSON", "/x.json"}, {"HOME", "/h"}})),
            std::vector<std::string>{"/x.json"});
}

TEST_F(OpenxrManifest, ActiveIsTheFirstThatExists) {
  const auto environment = environment_with(
      {{"XDG_CONFIG_HOME", folder_.path("own")}, {"XDG_CONFIG_DIRS", folder_.path()}});
  const std::string second = manifest("/x.so");
  EXPECT_EQ(active_manifest(environment), second);
  const std::string first = file("own/openxr/1/active_runtime.json", "{}");
  EXPECT_EQ(active_manifest(environment), first);
  EXPECT_EQ(active_manifest(environment_with({{"XR_RUNTIME_JSON", "/nowhere/x.json"}})),
            std::nullopt);
}

TEST_F(OpenxrManifest, FindsItsLibraryByAbsoluteAndByRelativePath) {
  const std::string library = file("lib/libruntime.so", "");
  EXPECT_EQ(error_of(manifest(library)), "it is fine: " + library);
  EXPECT_EQ(fs::weakly_canonical(*library_of(manifest("../../lib/libruntime.so"))),
            fs::weakly_canonical(library));
  // SteamVR's manifest is a link to one in its own folder.
  const std::string own = file("steam/steamxr.json", R"({"runtime":{"library_path":"bin/x.so"}})");
  file("steam/bin/x.so", "");
  fs::create_symlink(own, folder_.path("link.json"));
  EXPECT_EQ(fs::weakly_canonical(*library_of(folder_.path("link.json"))),
            fs::weakly_canonical(folder_.path("steam/bin/x.so")));
  EXPECT_EQ(library_of(manifest("libruntime.so.1")), "libruntime.so.1") << "the system finds it";
}

TEST_F(OpenxrManifest, NamesTheLibraryThatIsMissingAndTheCure) {
  const std::string path = manifest("/opt/gone/libruntime.so");
  EXPECT_EQ(error_of(path),
            "OpenXR manifest " + path +
                " names a library that is missing: /opt/gone/libruntime.so; install the headset's "
                "runtime again, or make another one active in its settings");
  EXPECT_NE(error_of(manifest("../gone.so")).find(folder_.path("openxr/gone.so")),
            std::string::npos);
}

TEST_F(OpenxrManifest, RefusesAFileThatIsNone) {
  for (const char* content :
       {"", "{", "[]", "null", "{}", R"({"runtime":[]})", R"({"runtime":{}})",
        R"({"runtime":{"library_path":7}})", R"({"runtime":{"library_path":""}})"}) {
    const std::string path = file("damaged.json", content);
    EXPECT_TRUE(error_of(path).starts_with("OpenXR manifest " + path)) << error_of(path);
    EXPECT_NE(error_of(path).find("install the headset's runtime again"), std::string::npos);
  }
  EXPECT_NE(error_of(folder_.path("none.json")).find("no such file"), std::string::npos);
}

}  // namespace
}  // namespace dance::openxr
