// Words of a text and the lines they stand on, for the BVH reader.
//
// Ownership: views into the text, which must outlive it.
// Threads:   none inside.
// Failure:   an empty word is the end of the text; to_number() returns nullopt for other words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace dance {

class BvhTokens {
 public:
  explicit BvhTokens(std::string_view text);

  // The next word; '{' and '}' are words of their own even without blanks around them.
  std::string_view next();
  std::string_view peek();
  // The rest of the line up to a '{', trimmed: a joint's name may hold blanks.
  std::string_view rest_of_line();
  // The line of the word that next() returned last, from 1.
  std::size_t line() const { return token_line_; }
  std::size_t remaining() const { return text_.size() - at_; }

 private:
  void skip_blanks();

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  std::size_t token_line_ = 1;
};

bool equals_ignoring_case(std::string_view a, std::string_view b);

// A decimal number with a point, whatever the locale; infinities and NaN parse as such.
std::optional<double> to_number(std::string_view word);
std::optional<long long> to_whole_number(std::string_view word);

// The word for an error message: short, plain text, in quotes.
std::string quoted(std::string_view word);

}  // namespace dance
