#include "formats/bvh/bvh_tokens.h"

#include <charconv>
#include <system_error>

#include "core/base/text/cut_text.h"
#include "core/base/text/plain_text.h"

namespace dance {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kLongestQuote = 40;

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v' || c == '\0';
}
constexpr char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

}  // namespace

BvhTokens::BvhTokens(std::string_view text) : text_(text) {
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
}

void BvhTokens::skip_blanks() {
  for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) {
    const bool lone_return =
        text_[at_] == '\r' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '\n');
    if (text_[at_] == '\n' || lone_return) ++line_;
  }
}

std::string_view BvhTokens::next() {
  skip_blanks();
  token_line_ = line_;
  const std::size_t begin = at_;
  if (at_ < text_.size() && (text_[at_] == '{' || text_[at_] == '}')) {
    ++at_;
  } else {
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '{' && text_[at_] != '}')
      ++at_;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view BvhTokens::peek() {
  const BvhTokens before = *this;
  const std::string_view word = next();
  *this = before;
  return word;
}

std::string_view BvhTokens::rest_of_line() {
  while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  const std::size_t begin = at_;
  while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r' && text_[at_] != '{') ++at_;
  std::size_t end = at_;
  while (end > begin && is_blank(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (lower(a[i]) != lower(b[i])) return false;
  return true;
}

std::optional<double> to_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // Underflow is 0; overflow is not a valid number of a body.
    const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return tiny ? std::optional(0.0) : std::nullopt;
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

std::optional<long long> to_whole_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size() || error != std::errc()) return std::nullopt;
  return value;
}

std::string quoted(std::string_view word) {
  std::string out = "'" + plain_text(cut_text(word, kLongestQuote));
  if (word.size() > kLongestQuote) out += "...";
  return out + "'";
}

}  // namespace dance
