// QR codes: the library's matrix, and what text and picture show of it.
#include "tunnel/invitation/qr_code.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/take_line.h"
#include "tests/apps/run_program.h"
#if DANCE_HAVE_QR
#include <qrencode.h>
#endif

namespace dance {
namespace {

constexpr const char* kLink =
    "dance://dance.example.org/"
    "salsa?v=1&guest=alice&key=AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA&"
    "until=20261127T0800Z&check=01234567";

// A code that is none: every square as good as a coin's throw.
QrCode some_squares(int size) {
  QrCode code;
  code.size = size;
  std::uint32_t state = 12345;
  for (int i = 0; i < size * size; ++i) {
    state = state * 1664525u + 1013904223u;
    code.dark.push_back((state >> 30 & 1) != 0);
  }
  return code;
}

// What an eye sees of the characters: true = dark.
std::vector<std::vector<bool>> seen(std::string_view text) {
  std::vector<std::vector<bool>> rows;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    std::vector<bool> upper, lower;
    while (!line.empty()) {
      const std::string_view character = line.substr(0, line[0] == ' ' ? 1 : 3);
      line.remove_prefix(character.size());
      upper.push_back(character == " " || character == "▄");
      lower.push_back(character == " " || character == "▀");
    }
    rows.push_back(std::move(upper));
    rows.push_back(std::move(lower));
  }
  return rows;
}

TEST(QrText, ShowsEachSquareAndTheQuietZone) {
  for (const int size : {21, 45}) {
    const QrCode code = some_squares(size);
    const auto rows = seen(qr_text(code, false));
    const int side = size + 2 * QrCode::kQuiet;
    // The second half of the last line may be none of the code.
    ASSERT_EQ(rows.size(), static_cast<std::size_t>((side + 1) / 2 * 2));
    for (int y = 0; y < side; ++y) {
      ASSERT_EQ(rows[static_cast<std::size_t>(y)].size(), static_cast<std::size_t>(side));
      for (int x = 0; x < side; ++x)
        ASSERT_EQ(rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)],
                  code.is_dark(x - QrCode::kQuiet, y - QrCode::kQuiet))
            << x << " " << y;
    }
  }
  const std::string coloured = qr_text(some_squares(21), true);
  EXPECT_EQ(coloured.find("\033[40;97m"), 0u);
  EXPECT_EQ(coloured.substr(coloured.size() - 5), "\033[0m\n");
}

TEST(QrSvg, PaintsEachDarkSquareOnce) {
  const QrCode code = some_squares(25);
  const std::string svg = qr_svg(code);
  std::vector<int> painted(25 * 25, 0);
  for (std::size_t at = svg.find('M'); at != std::string::npos; at = svg.find('M', at + 1)) {
    int x = 0, y = 0, length = 0;
    ASSERT_EQ(std::sscanf(svg.c_str() + at, "M%d %dh%dv1h-", &x, &y, &length), 3);
    for (int i = 0; i < length; ++i) ++painted[static_cast<std::size_t>((y - 4) * 25 + x - 4 + i)];
  }
  for (std::size_t i = 0; i < painted.size(); ++i) EXPECT_EQ(painted[i], code.dark[i] ? 1 : 0);
  EXPECT_NE(svg.find("viewBox=\"0 0 33 33\""), std::string::npos);
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

#if DANCE_HAVE_QR
TEST(QrCode, IsTheLibrarysMatrixWithItsThreeFinders) {
  const auto code = make_qr_code(kLink);
  ASSERT_TRUE(code) << code.error().what;
  QRcode* made = QRcode_encodeString8bit(kLink, 0, QR_ECLEVEL_M);
  ASSERT_NE(made, nullptr);
  ASSERT_EQ(code->size, made->width);
  for (int y = 0; y < code->size; ++y)
    for (int x = 0; x < code->size; ++x)
      ASSERT_EQ(code->is_dark(x, y), (made->data[y * made->width + x] & 1) != 0);
  QRcode_free(made);
  // Rings of dark, light and a dark heart in three corners.
  for (const auto& [left, top] :
       {std::pair(0, 0), std::pair(code->size - 7, 0), std::pair(0, code->size - 7)})
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 7; ++x) {
        const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
        EXPECT_EQ(code->is_dark(left + x, top + y), ring != 2);
      }
  EXPECT_FALSE(make_qr_code(std::string(5000, 'x')));
}

// Another's program reads what the terminal shows.
TEST(QrCode, AScannerReadsTheLinkFromTheTerminal) {
  if (run("command -v zbarimg").exit_code != 0) GTEST_SKIP() << "zbarimg (zbar-tools) is not here";
  constexpr std::size_t kPixels = 4;
  const auto code = make_qr_code(kLink);
  ASSERT_TRUE(code);
  const auto rows = seen(qr_text(*code, false));
  const TestFolder folder("qr-code");
  {
    std::ofstream picture(folder.path("code.pbm"));
    picture << "P1\n" << rows[0].size() * kPixels << " " << rows.size() * kPixels << "\n";
    for (const auto& row : rows)
      for (std::size_t i = 0; i < kPixels; ++i) {
        for (const bool is_dark : row)
          for (std::size_t k = 0; k < kPixels; ++k) picture << (is_dark ? "1 " : "0 ");
        picture << "\n";
      }
  }
  const Finished read = run("zbarimg --quiet --raw " + folder.path("code.pbm"));
  EXPECT_EQ(read.output, std::string(kLink) + "\n") << read.talk;
}
#else
TEST(QrCode, IsMissedWithTheCure) {
  const auto code = make_qr_code(kLink);
  ASSERT_FALSE(code);
  EXPECT_NE(code.error().what.find("libqrencode-dev"), std::string::npos);
}
#endif

}  // namespace
}  // namespace dance
