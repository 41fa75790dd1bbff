// Houses that choose avatars: by session and by command, and the file that then arrives at the
// other house.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kServer = "127.0.0.1:7446";

class HouseAvatarPrograms : public BusPrograms {
 protected:
  void SetUp() override {
    // One that no house has: a shipped one under another name.
    std::string avatar = text_of(DANCE_SOURCE_DIR "/data/avatars/teo.vrm");
    const std::size_t name = avatar.find("\"teo\"");
    ASSERT_NE(name, std::string::npos);
    avatar.replace(name, 5, "\"tia\"");
    std::ofstream(folder_.path("me.vrm"), std::ios::binary) << avatar;
    start("dance-server", {"--port", "7446", "--bind", "127.0.0.1"});
  }
  // A house with stores of its own.
  void open(const char* guest, const char* bus, const std::string& more) {
    const std::string session = folder_.path(std::string(guest) + ".toml");
    std::ofstream(session) << "[house]\nguest = \"" << guest << "\"\nserver = \"" << kServer
                           << "\"\nroom = \"salsa\"\nbus = \"" << bus
                           << "\"\nview = false\navatar_bytes_per_second = 4000000\n"
                           << "[[produce]]\nkind = \"salsa\"\nguest = \"" << guest << "\"\n"
                           << "[[route]]\nfrom = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\n"
                           << more;
    start("/usr/bin/env", {"XDG_DATA_HOME=" + folder_.path(std::string(guest) + "-data"),
                           "XDG_CACHE_HOME=" + folder_.path(std::string(guest) + "-cache"),
                           bin("dance-join"), session});
  }
  // The files in a guest's cache that are whole.
  std::vector<std::string> cached(const char* guest) const {
    std::vector<std::string> files;
    std::error_code error;
    for (const auto& it : std::filesystem::directory_iterator(
             folder_.path(std::string(guest) + "-cache/dancegraph/avatars"), error))
      if (it.path().extension() == ".vrm") files.push_back(it.path().string());
    return files;
  }
};

TEST_F(HouseAvatarPrograms, TheFileOfASessionArrivesInTheOtherHouse) {
  open("alice", kBus, "[[avatar]]\nguest = \"alice\"\nfile = \"me.vrm\"\nheight = 1.1\n");
  open("bob", kOtherBus, "");
  auto ear = Bus::open(kOtherBus);
  ASSERT_TRUE(ear);
  std::optional<Avatar> avatar;
  std::optional<AvatarFile> file;
  const GuestId alice = *GuestId::parse("alice");
  (*ear)->subscribe<Avatar>({Where::kGuest, alice},
                            [&](const Channel&, const Avatar& it, MonoTime) { avatar = it; });
  (*ear)->subscribe<AvatarFile>({Where::kGuest, alice},
                                [&](const Channel&, const AvatarFile& it, MonoTime) { file = it; });
  ASSERT_TRUE(wait_for([&] {
    (*ear)->drain(mono_now());
    return avatar && file && !cached("bob").empty();
  })) << text_of(folder_.path("talk"));
  EXPECT_FLOAT_EQ(avatar->height_scale, 1.1f);
  EXPECT_EQ(file->name.view(), "me.vrm");
  ASSERT_EQ(cached("bob").size(), 1u);
  EXPECT_EQ(text_of(cached("bob")[0]), text_of(folder_.path("me.vrm")));
  EXPECT_NE(cached("bob")[0].find(hex_of(file->hash)), std::string::npos);
}

TEST_F(HouseAvatarPrograms, AChoiceOnTheBusHoldsUntilTheNext) {
  open("alice", kBus, "");
  open("bob", kOtherBus, "");
  auto ear = Bus::open(kOtherBus);
  ASSERT_TRUE(ear);
  std::string name;
  bool has_file = false;
  int said = 0;
  const GuestId alice = *GuestId::parse("alice");
  (*ear)->subscribe<Avatar>({Where::kGuest, alice},
                            [&](const Channel&, const Avatar& it, MonoTime) {
                              name = it.name.view();
                              ++said;
                            });
  (*ear)->subscribe<AvatarFile>(
      {Where::kGuest, alice},
      [&](const Channel&, const AvatarFile& it, MonoTime) { has_file = it.hash.is_set(); });
  const auto comes_to = [&](const auto& condition) {
    return wait_for([&] {
      (*ear)->drain(mono_now());
      return condition();
    });
  };
  const std::string choose =
      "XDG_DATA_HOME=" + folder_.path("alice-data") + " " + bin("dance-avatar choose alice ");
  const std::string bus = " --bus " + quoted(kBus);
  ASSERT_TRUE(wait_for(
      [&] { return text_of(folder_.path("talk")).find("alice is here") != std::string::npos; }));
  const Finished first = run(choose + "mannequin --look dress-bun --colour '#e04080'" + bus);
  ASSERT_EQ(first.exit_code, 0) << first.talk;
  EXPECT_EQ(first.talk.find("no house keeps"), std::string::npos) << first.talk;
  ASSERT_TRUE(comes_to([&] { return name == "dress-bun"; })) << text_of(folder_.path("talk"));
  const int before = said;
  ASSERT_TRUE(comes_to([&] { return said >= before + 3; })) << "it is said again each second";
  ASSERT_EQ(run(choose + folder_.path("me.vrm") + bus).exit_code, 0);
  ASSERT_TRUE(comes_to([&] { return has_file; }));
  ASSERT_TRUE(comes_to([&] { return !cached("bob").empty(); })) << text_of(folder_.path("talk"));
  // Who uses what.
  const auto rows = nlohmann::json::parse(
      run("XDG_CACHE_HOME=" + folder_.path("bob-cache") +
          " XDG_DATA_HOME=" + folder_.path("bob-data") + " " +
          bin("dance-avatar list --json --seconds 3 --bus ") + quoted(kOtherBus))
          .output,
      nullptr, false);
  ASSERT_TRUE(rows.is_array());
  const auto fetched =
      std::ranges::find_if(rows, [](const auto& row) { return row["kind"] == "fetched"; });
  ASSERT_NE(fetched, rows.end()) << rows;
  EXPECT_EQ((*fetched)["guests"], nlohmann::json({"alice"}));
  EXPECT_EQ((*fetched)["name"], "me.vrm");
  // And back.
  ASSERT_EQ(run(choose + "mannequin" + bus).exit_code, 0);
  ASSERT_TRUE(comes_to([&] { return name == "mannequin" && !has_file; }));
}

TEST_F(HouseAvatarPrograms, AChoiceThatNoHouseKeepsIsSaid) {
  const Finished finished =
      run(bin("dance-avatar choose alice mannequin --bus ") + quoted(kOtherBus));
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_NE(finished.talk.find("--stay"), std::string::npos) << finished.talk;
}

TEST_F(HouseAvatarPrograms, AWrongChoiceIsOneLineThatSaysWhatThereIs) {
  std::ofstream(folder_.path("broken.vrm")) << "no avatar";
  for (const auto& [arguments, code, part] :
       {std::tuple("choose alice nobody", 1, "flared"),
        std::tuple("choose alice mannequin --look hat", 1, "hat"),
        std::tuple("choose alice mannequin --colour red", 1, "#e04080"),
        std::tuple("choose alice mannequin --height 9", 2, "--height"),
        std::tuple("choose 'NOT A GUEST' mannequin", 2, "NOT A GUEST"),
        std::tuple("choose", 2, "GUEST")}) {
    const Finished finished = run(bin("dance-avatar ") + arguments);
    EXPECT_EQ(finished.exit_code, code) << arguments << finished.talk;
    EXPECT_NE(finished.talk.find(part), std::string::npos) << finished.talk;
  }
  const Finished broken = run(bin("dance-avatar choose alice ") + folder_.path("broken.vrm"));
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_NE(broken.talk.find("cannot be read"), std::string::npos) << broken.talk;
}

}  // namespace
}  // namespace dance
