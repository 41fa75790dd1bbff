#include "apps/avatar/avatar_make.h"

#include <fmt/format.h>

#include <cstdio>

#include "core/program/program.h"
#include "core/program/whole_file.h"
#include "formats/avatar/make/avatar_maker.h"
#include "formats/avatar/vrm_writer.h"

namespace dance {
namespace {

constexpr const char* kMakeExamples = R"(Examples:
  dance avatar make --out marisol.vrm --look marisol      a follower; comes with the project
  dance avatar make --out teo.vrm --look teo              a leader, likewise
  dance avatar make --out alice.vrm --guest alice         alice's clothes on the stage
  dance avatar make --out me.vrm --look teo --height 1.92 --hair bun --top 2f7fd1 --skin c98a5e
The file is VRM 1.0, under CC0 1.0 (no rights reserved); see what is in it with dance avatar info.
)";

struct MakeOptions {
  std::string out;
  std::string look;
  std::string guest;
  std::string name;
  double height_m = 0.0;
  std::string hair;
  std::string clothes;
  std::string sleeves;
  std::string pattern;
  // Colours as RRGGBB.
  std::string skin;
  std::string top;
  std::string legs;
  std::string shoes;
  std::string hair_colour;
  std::string eyes;
  std::string sash;
};

std::string wrong_colour(const std::string& text) {
  const bool is_hex =
      text.size() == 6 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  return is_hex ? "" : "a colour is six hexadecimal digits, RRGGBB, such as c4203a";
}

template <class T>
void choose(T& value, const std::string& word, const std::vector<Choice<T>>& choices) {
  for (const Choice<T>& choice : choices)
    if (word == choice.word) value = choice.value;
}

void paint(Eigen::Vector3f& colour, const std::string& rgb) {
  if (!rgb.empty())
    colour = linear_from_srgb(static_cast<std::uint32_t>(std::stoul(rgb, nullptr, 16)));
}

AvatarDesign design_of(const MakeOptions& options) {
  AvatarDesign design = !options.guest.empty()
                            ? design_of(GuestId::parse(options.guest).value())
                            : find_design(options.look.empty() ? design_names().front()
                                                               : std::string_view(options.look))
                                  .value();
  if (!options.name.empty()) design.name = options.name;
  if (options.height_m > 0.0) design.height_m = static_cast<float>(options.height_m);
  GuestLook& look = design.look;
  choose<Hair>(look.hair_style, options.hair,
               {{"short", Hair::kShort},
                {"bob", Hair::kBob},
                {"bun", Hair::kBun},
                {"ponytail", Hair::kPonytail}});
  choose<Legwear>(
      look.legwear, options.clothes,
      {{"trousers", Legwear::kTrousers}, {"flared", Legwear::kFlared}, {"skirt", Legwear::kSkirt}});
  choose<Sleeves>(look.sleeves, options.sleeves,
                  {{"none", Sleeves::kNone}, {"short", Sleeves::kShort}, {"long", Sleeves::kLong}});
  choose<ClothPattern>(design.pattern, options.pattern,
                       {{"plain", ClothPattern::kPlain},
                        {"dots", ClothPattern::kDots},
                        {"stripes", ClothPattern::kStripes},
                        {"petals", ClothPattern::kPetals}});
  paint(look.skin, options.skin);
  paint(look.top, options.top);
  paint(look.legs,
        options.legs.empty() && look.legwear == Legwear::kSkirt ? options.top : options.legs);
  paint(look.shoes, options.shoes);
  paint(look.hair, options.hair_colour);
  paint(design.eyes, options.eyes);
  paint(design.sash, options.sash);
  return design;
}

Result<void> make(const MakeOptions& options) {
  if (auto can = try_whole_file(options.out); !can) return can;
  const AvatarModel model = make_avatar(design_of(options));
  VrmMeta meta;
  meta.authors = {"DanceGraph"};
  meta.licence_url = kAvatarLicenceUrl;
  DANCE_TRY(const std::vector<std::uint8_t> file, write_vrm(model, meta));
  if (auto written = write_whole_file(options.out, std::span(file)); !written) return written;
  fmt::print("{}: {}, {} triangles, {} vertices, {:.0f} kB\n", options.out, model.name,
             model.triangles.size() / 3, model.vertices.size(),
             static_cast<double>(file.size()) / 1000.0);
  return {};
}

}  // namespace

int avatar_make_main(int argc, char** argv) {
  MakeOptions options;
  CommandLine line("Makes an avatar of the project's own design, as a VRM 1.0 file.",
                   "dance avatar make");
  std::vector<std::string> looks;
  for (const std::string_view name : design_names()) looks.emplace_back(name);
  line.add("--out", options.out, "file to write, .vrm").required();
  line.add("--look", options.look, "which design to begin with (else the first)").one_of(looks);
  line.add("--guest", options.guest, "begins with what this guest wears on the stage").guest_name();
  line.add("--name", options.name, "what the file calls the avatar (else as its design)")
      .guest_name();
  line.add("--height", options.height_m, "metres (else the design's)").range(1.2, 2.2);
  line.add("--hair", options.hair, "").one_of({"short", "bob", "bun", "ponytail"});
  line.add("--clothes", options.clothes, "skirt: it swings; else a sash does")
      .one_of({"trousers", "flared", "skirt"});
  line.add("--sleeves", options.sleeves, "").one_of({"none", "short", "long"});
  line.add("--pattern", options.pattern, "of the skirt, or of the shirt")
      .one_of({"plain", "dots", "stripes", "petals"});
  line.add("--skin", options.skin, "colour, RRGGBB").check(wrong_colour);
  line.add("--top", options.top, "colour of the shirt or the dress").check(wrong_colour);
  line.add("--legs", options.legs, "colour of the trousers or the skirt").check(wrong_colour);
  line.add("--shoes", options.shoes, "colour").check(wrong_colour);
  line.add("--hair-colour", options.hair_colour, "colour").check(wrong_colour);
  line.add("--eyes", options.eyes, "colour of the irises").check(wrong_colour);
  line.add("--sash", options.sash, "colour of sash or belt").check(wrong_colour);
  line.finally([&]() -> Result<void> {
    if (!options.look.empty() && !options.guest.empty())
      return fail("--look and --guest: an avatar begins with one of them");
    return {};
  });
  line.footer(kMakeExamples);
  return run_program(line, argc, argv, [&] { return make(options); });
}

}  // namespace dance
