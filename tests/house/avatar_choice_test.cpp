// What a person writes to choose an avatar, and what the bus then hears.
#include "house/avatar_choice.h"

#include <gtest/gtest.h>

#include "core/store/sha256.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/avatar/vrm_writer.h"
#include "formats/body/guest_look.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

class Choice : public ::testing::Test {
 protected:
  Choice() {
    VrmMeta meta;
    meta.name = "me";
    meta.authors = {"a dancer"};
    auto written = write_vrm(mannequin_model(average_skeleton(), look_of(GuestId()), false), meta);
    EXPECT_TRUE(written) << written.error().what;
    if (written) avatar = std::move(*written);
    std::filesystem::create_directories(folder.path("shipped"));
    write("me.vrm", avatar);
    write("shipped/marisol.vrm", avatar);
    write("shipped/README.md", {'x'});
  }
  void write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    std::ofstream(folder.path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  AvatarStore store() const { return AvatarStore(folder.path("data"), folder.path("cache")); }
  Result<ChosenAvatar> choose(const AvatarChoice& choice) const {
    return choose_avatar(choice, store(), folder.path("shipped"));
  }
  std::string error_of(const AvatarChoice& choice) const {
    const auto chosen = choose(choice);
    return chosen ? "no error" : chosen.error().what;
  }

  TestFolder folder{"choice"};
  std::vector<std::uint8_t> avatar;
};

TEST_F(Choice, OfAFileKeepsACopyAndNamesItByItsHash) {
  const auto chosen = choose({folder.path("me.vrm"), "", "", 1.1});
  ASSERT_TRUE(chosen) << chosen.error().what;
  EXPECT_EQ(chosen->file.hash, sha256_of(avatar));
  EXPECT_EQ(chosen->file.size_bytes, static_cast<int>(avatar.size()));
  EXPECT_EQ(chosen->file.name.view(), "me.vrm");
  EXPECT_FLOAT_EQ(chosen->avatar.height_scale, 1.1f);
  EXPECT_FALSE(chosen->avatar.name.is_set());
  EXPECT_TRUE(is_valid(chosen->file) && is_valid(chosen->avatar));
  EXPECT_EQ(store().read(chosen->file.hash), avatar);
  // The file may go or change: the copy stays.
  std::filesystem::remove(folder.path("me.vrm"));
  EXPECT_EQ(store().read(chosen->file.hash), avatar);
}

TEST_F(Choice, OfANameIsNoFile) {
  for (const auto& [choice, name] :
       {std::pair(AvatarChoice{"marisol", "", "", 1.0}, "marisol"),
        std::pair(AvatarChoice{"mannequin", "", "", 1.0}, "mannequin"),
        std::pair(AvatarChoice{"mannequin", "dress-bun", "", 1.0}, "dress-bun"),
        std::pair(AvatarChoice{"", "flared", "", 1.0}, "flared"),
        std::pair(AvatarChoice{"flared-tail", "", "", 1.0}, "flared-tail")}) {
    const auto chosen = choose(choice);
    ASSERT_TRUE(chosen) << name << ": " << chosen.error().what;
    EXPECT_EQ(chosen->avatar.name.view(), name);
    EXPECT_FALSE(chosen->file.hash.is_set());
  }
  EXPECT_EQ(shipped_avatars(folder.path("shipped")), std::vector<std::string>{"marisol"});
}

TEST_F(Choice, OfAColourIsLinear) {
  const auto chosen = choose({"mannequin", "", "#ff0080", 1.0});
  ASSERT_TRUE(chosen);
  EXPECT_FLOAT_EQ(chosen->avatar.colour_rgb[0], 1.0f);
  EXPECT_FLOAT_EQ(chosen->avatar.colour_rgb[1], 0.0f);
  EXPECT_NEAR(chosen->avatar.colour_rgb[2], 0.2159f, 1e-3f);
  for (const char* colour : {"red", "#ff00", "#ff00800", "#gg0000", "#-f0080"})
    EXPECT_NE(error_of({"mannequin", "", colour, 1.0}).find("#e04080"), std::string::npos)
        << colour;
}

TEST_F(Choice, ThatCannotBeMadeSaysWhyAndWhatThereIs) {
  const std::string unknown = error_of({"nobody", "", "", 1.0});
  EXPECT_NE(unknown.find("marisol"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("flared"), std::string::npos) << unknown;
  EXPECT_NE(error_of({"nothing.vrm", "", "", 1.0}).find("nothing.vrm"), std::string::npos);
  write("broken.glb", std::vector<std::uint8_t>(1000, 7));
  const std::string broken = error_of({folder.path("broken.glb"), "", "", 1.0});
  EXPECT_NE(broken.find("broken.glb cannot be read: "), std::string::npos) << broken;
  EXPECT_TRUE(store().list().empty()) << "what cannot be read is not kept";
  std::filesystem::resize_file(folder.path("broken.glb"), (16u << 20) + 1);
  EXPECT_NE(error_of({folder.path("broken.glb"), "", "", 1.0}).find("at most 16"),
            std::string::npos);
  EXPECT_NE(error_of({"marisol", "dress", "", 1.0}).find("look"), std::string::npos);
  EXPECT_NE(error_of({"mannequin", "hat", "", 1.0}).find("hat"), std::string::npos);
  EXPECT_NE(error_of({"mannequin", "", "", 9.0}).find("0.25 to 4"), std::string::npos);
  EXPECT_NE(error_of({"../marisol", "", "", 1.0}), "no error");
}

TEST_F(Choice, OfAGuestStandsBeforeAnEqualsSign) {
  EXPECT_EQ(parse_avatar_of_guest("alice=me.vrm").guest.view(), "alice");
  EXPECT_EQ(parse_avatar_of_guest("alice=me.vrm").what, "me.vrm");
  EXPECT_FALSE(parse_avatar_of_guest("me.vrm").guest.is_set());
  EXPECT_EQ(parse_avatar_of_guest("A=B.vrm").what, "A=B.vrm");
}

}  // namespace
}  // namespace dance
