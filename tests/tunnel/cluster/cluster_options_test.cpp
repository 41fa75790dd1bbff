// Tests how a program reads its login for NATS, hidden from other users of the machine.
#include "tunnel/server/program/cluster/cluster_options.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/test_folder.h"

namespace dance {
namespace {

class ClusterLogin : public ::testing::Test {
 protected:
  std::string file(const std::string& text, mode_t mode = 0600) {
    const std::string path = folder_.path("login");
    std::ofstream(path, std::ios::trunc) << text;
    EXPECT_EQ(::chmod(path.c_str(), mode), 0);
    return path;
  }
  static std::string error_of(const ClusterOptions& options) {
    const auto nats = nats_options_of(options);
    return nats ? "" : nats.error().what;
  }
  TestFolder folder_{"login"};
};

TEST_F(ClusterLogin, IsRefusedInAUrlOfTheCommandLineWithTheCure) {
  for (const char* urls :
       {"nats://me:secret@a:4222", "me:secret@a", "nats://a:4222,tls://token-secret@b:4222"}) {
    ClusterOptions options;
    options.urls = urls;
    const std::string error = error_of(options);
    EXPECT_NE(error.find("--cluster-login FILE"), std::string::npos) << error;
    EXPECT_NE(error.find("chmod 600"), std::string::npos) << error;
    EXPECT_EQ(error.find("secret"), std::string::npos) << error;
  }
}

TEST_F(ClusterLogin, OfAFileGoesIntoEachUrlAndIsNotShown) {
  ClusterOptions options;
  options.urls = "nats://a:4222,tls://b:4222,c";
  options.login = file("me:s3cret!\n");
  const auto nats = nats_options_of(options);
  ASSERT_TRUE(nats) << nats.error().what;
  EXPECT_EQ(nats->urls,
            (std::vector<std::string>{"nats://me:s3cret!@a:4222", "tls://me:s3cret!@b:4222",
                                      "nats://me:s3cret!@c"}));
  EXPECT_EQ(shown_urls(*nats), "nats://a:4222, tls://b:4222, nats://c");
}

TEST_F(ClusterLogin, IsRefusedWhereOthersMayReadItsFile) {
  for (const mode_t mode : {0640u, 0604u, 0620u}) {
    ClusterOptions options;
    options.urls = "nats://a:4222";
    options.login = file("me:secret\n", mode);
    EXPECT_NE(error_of(options).find("chmod 600"), std::string::npos) << error_of(options);
    // A file of credentials is refused in the same way.
    ClusterOptions credentials;
    credentials.urls = "nats://a:4222";
    credentials.nats.credentials = options.login;
    EXPECT_NE(error_of(credentials).find("chmod 600"), std::string::npos) << error_of(credentials);
  }
}

TEST_F(ClusterLogin, NamesAFileThatIsMissingOrInvalid) {
  ClusterOptions options;
  options.urls = "nats://a:4222";
  options.login = folder_.path("none");
  EXPECT_NE(error_of(options).find("no such file"), std::string::npos);
  for (const char* text :
       {"", "\n", "me:se cret", "me:a@b", "me:a/b", "two\nlines", "me:\x1b[2J"}) {
    options.login = file(text);
    EXPECT_NE(error_of(options).find("USER:PASSWORD"), std::string::npos) << text;
    EXPECT_EQ(error_of(options).find('\x1b'), std::string::npos);
  }
}

}  // namespace
}  // namespace dance
