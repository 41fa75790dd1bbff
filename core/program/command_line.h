// The options of a program, over CLI11. Its headers cost ten seconds in every file that includes
// them (thirty under sanitizers), so only one file does.
//
// Ownership: values are the caller's and must outlive parse(); an Option is a handle on the
//            CommandLine's own.
// Threads:   one.
// Failure:   parse() returns one line that names the option and what it takes.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace dance {

// What an option takes; every call returns the same option.
class Option {
 public:
  Option& range(double lowest, double highest);
  Option& one_of(std::vector<std::string> words);
  // "" when the text is valid, else the error.
  Option& check(std::function<std::string(const std::string& text)> wrong);
  Option& guest_name();
  Option& required();
  // --help shows the present value as default.
  Option& shows_default();
  Option& split_at(char separator);
  // Takes one value each time it is given; further words are not part of it.
  Option& one_each_time();
  Option& hidden();

 private:
  friend class CommandLine;
  explicit Option(CLI::Option* option) : option_(option) {}
  CLI::Option* option_;
};

// One word of an option with a choice of words, and its meaning.
template <class T>
struct Choice {
  const char* word;
  T value;
};

class CommandLine {
 public:
  CommandLine(const std::string& purpose, const std::string& name);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // T: std::string, double, int, std::int64_t, std::uint16_t, std::uint32_t, std::uint64_t, and
  // vectors of the first two. A name without dashes is a positional argument.
  template <class T>
  Option add(const std::string& name, T& value, const std::string& help);
  Option add_flag(const std::string& name, bool& value, const std::string& help);
  template <class T, class Value>
  Option add_choice(const std::string& name, Value& value, std::vector<Choice<T>> choices,
                    const std::string& help) {
    std::vector<std::string> words;
    for (const Choice<T>& choice : choices) words.push_back(choice.word);
    return add_words(
        name, words, [&value, choices](std::size_t i) { value = choices[i].value; }, help);
  }
  void footer(const std::string& text);
  // Validates all options after parsing: an Error is wrong use.
  void finally(std::function<Result<void>()> look);

  enum class Parsed { kRun, kHelp, kWrong };
  // kHelp: text() is the help. kWrong: text() is the error.
  Parsed parse(int argc, char** argv);
  const std::string& text() const { return text_; }
  std::string name() const;

 private:
  // `chosen` is called with the number of the word.
  Option add_words(const std::string& name, std::vector<std::string> words,
                   std::function<void(std::size_t)> chosen, const std::string& help);

  std::unique_ptr<CLI::App> app_;
  std::function<Result<void>()> look_;
  std::string text_;
};

}  // namespace dance
