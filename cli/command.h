#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/console.h"

namespace uw {

/// The program's exit codes (docs/command-line.md).
enum ExitCode : int {
    k_exit_done = 0,
    k_exit_internal = 1,
    k_exit_usage = 2,
    k_exit_input = 3,
    k_exit_io = 4,
    k_exit_validation = 5,
    k_exit_interrupted = 130,
};

/// The same in words, for the manual page.
inline constexpr std::array<std::pair<ExitCode, std::string_view>, 7> k_exit_meanings{
    {{k_exit_done, "done"},
     {k_exit_internal, "internal fault"},
     {k_exit_usage, "wrong usage"},
     {k_exit_input, "bad input: a scene, volume, mesh or another file is wrong"},
     {k_exit_io, "a file cannot be read or written"},
     {k_exit_validation, "a validation failed"},
     {k_exit_interrupted, "interrupted"}}};

/// One option, flag or positional argument of a command as data, from which the parser, --help, the
/// manual page and the shell completions are made.
struct Option {
    enum class Value {
        none,      // a flag
        text,      // anything
        input,     // a file to be read
        output,    // a file to be written, or the beginning of a file's name
        word,      // one of `words`
        word_list  // some of `words`, separated by commas
    };

    std::string names;       // "-o,--output"; without a dash a positional argument: "SCENE"
    std::string value_name;  // the placeholder of the value in help: "OUT.exr"
    std::string help;        // one line
    Value value = Value::none;
    std::vector<std::string> words;
    bool required = false;
    bool repeatable = false;
    std::string needs;  // the name of an option that must be given as well; empty: none
    /// Takes the text given (empty for a flag). Throws UsageError of one line.
    std::function<void(const std::string& text)> take;

    bool is_positional() const { return !names.starts_with('-'); }
    bool is_flag() const { return value == Value::none; }
    bool is_path() const { return value == Value::input || value == Value::output; }
    /// The long name, or that of a positional argument, for messages.
    std::string name() const;
};

/// What a command accepts. Each function declares one option, whose value is written to its
/// variable when the command line is read; the variable outlives the options. The references
/// returned remain valid.
class Options {
  public:
    /// A switch: true if it is given.
    Option& flag(std::string names, bool& variable, std::string help);
    /// Any text.
    Option& text(std::string names, std::string value_name, std::string& variable,
                 std::string help);
    /// The name of a file that is read.
    Option& input(std::string names, std::string value_name, std::filesystem::path& variable,
                  std::string help);
    /// The name of a file that is written, or of a folder of such files.
    Option& output(std::string names, std::string value_name, std::filesystem::path& variable,
                   std::string help);
    /// A whole number within [low, high].
    Option& integer(std::string names, std::string value_name, std::optional<int>& variable,
                    int low, int high, std::string help);
    Option& integer(std::string names, std::string value_name, int& variable, int low, int high,
                    std::string help);
    /// A number above `low`, at most `high`.
    Option& number(std::string names, std::string value_name, std::optional<double>& variable,
                   double low, double high, std::string help);
    Option& number(std::string names, std::string value_name, double& variable, double low,
                   double high, std::string help);
    /// Text that `take` parses, or rejects with a UsageError.
    Option& parsed(std::string names, std::string value_name,
                   std::function<void(const std::string&)> take, std::string help);

    /// `--set KEY.PATH=VALUE`, any number of times.
    void set(std::vector<std::string>& overrides);
    /// `--size WxH`, with the limits of a scene's camera.resolution.
    void size(std::optional<std::array<int, 2>>& variable, std::string help);
    /// `NAMES X0,Y0,X1,Y1`: pixels, x1 and y1 excluded.
    void window(std::string names, std::optional<std::array<int, 4>>& variable, std::string help);
    /// `--threads N`.
    void threads(int& variable);
    /// `--confine`: confine_inputs.
    void confine();
    /// `--quiet` and `--progress`, by which `quiet` hides progress as text.
    void messages(bool& quiet, ProgressForm& progress);

    /// All that were declared, in that order.
    const std::deque<Option>& all() const { return all_; }

  private:
    std::deque<Option> all_;
};

/// A command of the program: `uwvdb NAME`.
struct Command {
    std::string name;
    std::string summary;  // one line, in lower case: "render a scene to a multi-layer EXR"
    std::string
        examples;  // what --help ends with: "Examples:\n  uwvdb ...", explanations, exit codes
    Options options;
    /// Does the work, after the options have been read. Owns the variables that hold them.
    std::function<ExitCode()> run;
};

/// Parses the command line: sets the variables of the chosen command's options, and returns its
/// `run`, or a function that prints the requested help or version. Throws UsageError of one line if
/// it is wrong, with the nearest right word. `commands` outlive the result.
std::function<ExitCode()> read_command_line(int argc, const char* const* argv,
                                            std::span<const Command> commands);

}  // namespace uw
