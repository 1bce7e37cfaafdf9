#include "cli/command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/scene/camera_desc.h"

namespace uw {

namespace {

/// All of `text` as a number of type T; empty if it is not one.
template <class T>
std::optional<T> number_in(const std::string& text) {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || next != end) return std::nullopt;
    return value;
}

int integer_within(const std::string& name, const std::string& text, int low, int high) {
    const std::optional<int> value = number_in<int>(text);
    if (value && *value >= low && *value <= high) return *value;
    throw UsageError(
        fmt::format("{}: expected {} to {}, found '{}'", name, low, high, printable(text)));
}

double number_within(const std::string& name, const std::string& text, double low, double high) {
    const std::optional<double> value = number_in<double>(text);
    if (value && *value > low && *value <= high) return *value;
    throw UsageError(fmt::format("{}: expected a number above {}, at most {}; found '{}'", name,
                                 low, high, printable(text)));
}

/// N whole numbers; `form` is what a message says they look like.
template <std::size_t N>
std::array<int, N> integers_in(const std::string& text, char separator, const std::string& option,
                               const char* form) {
    std::array<int, N> values{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < N; ++i) {
        const auto [next, error] = std::from_chars(at, end, values[i]);
        const bool last = i + 1 == N;
        if (error != std::errc() || (last ? next != end : next == end || *next != separator))
            throw UsageError(
                fmt::format("{}: expected {}, found '{}'", option, form, printable(text)));
        at = next + 1;
    }
    return values;
}

}  // namespace

std::string Option::name() const {
    const std::size_t comma = names.rfind(',');
    return comma == std::string::npos ? names : names.substr(comma + 1);
}

Option& Options::flag(std::string names, bool& variable, std::string help) {
    Option& option = all_.emplace_back();
    option.names = std::move(names);
    option.help = std::move(help);
    option.take = [&variable](const std::string&) { variable = true; };
    return option;
}

Option& Options::parsed(std::string names, std::string value_name,
                        std::function<void(const std::string&)> take, std::string help) {
    Option& option = all_.emplace_back();
    option.names = std::move(names);
    option.value_name = std::move(value_name);
    option.help = std::move(help);
    option.value = Option::Value::text;
    option.take = std::move(take);
    return option;
}

Option& Options::text(std::string names, std::string value_name, std::string& variable,
                      std::string help) {
    return parsed(
        std::move(names), std::move(value_name),
        [&variable](const std::string& text) { variable = text; }, std::move(help));
}

Option& Options::input(std::string names, std::string value_name, std::filesystem::path& variable,
                       std::string help) {
    Option& option = parsed(
        std::move(names), std::move(value_name),
        [&variable](const std::string& text) { variable = text; }, std::move(help));
    option.value = Option::Value::input;
    return option;
}

Option& Options::output(std::string names, std::string value_name, std::filesystem::path& variable,
                        std::string help) {
    Option& option = input(std::move(names), std::move(value_name), variable, std::move(help));
    option.value = Option::Value::output;
    return option;
}

Option& Options::integer(std::string names, std::string value_name, std::optional<int>& variable,
                         int low, int high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = integer_within(name, text, low, high);
    };
    return option;
}

Option& Options::integer(std::string names, std::string value_name, int& variable, int low,
                         int high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = integer_within(name, text, low, high);
    };
    return option;
}

Option& Options::number(std::string names, std::string value_name, std::optional<double>& variable,
                        double low, double high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = number_within(name, text, low, high);
    };
    return option;
}

Option& Options::number(std::string names, std::string value_name, double& variable, double low,
                        double high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = number_within(name, text, low, high);
    };
    return option;
}

void Options::set(std::vector<std::string>& overrides) {
    Option& option = parsed(
        "--set", "KEY.PATH=VALUE",
        [&overrides](const std::string& text) { overrides.push_back(text); },
        "replace a value of the scene file; may be repeated");
    option.repeatable = true;
}

void Options::size(std::optional<std::array<int, 2>>& variable, std::string help) {
    const auto take = [&variable](const std::string& text) {
        const auto size = integers_in<2>(text, 'x', "--size", "WxH such as 640x360");
        if (std::ranges::any_of(size,
                                [](int side) { return side < 1 || side > k_longest_image_side; }))
            throw UsageError(
                fmt::format("--size: each side must be 1 to {} pixels", k_longest_image_side));
        if (const std::string fault = too_many_pixels(size[0], size[1]); !fault.empty())
            throw UsageError("--size: " + fault);
        variable = size;
    };
    parsed("--size", "WxH", take, std::move(help));
}

void Options::window(std::string names, std::optional<std::array<int, 4>>& variable,
                     std::string help) {
    Option& option = parsed(std::move(names), "x0,y0,x1,y1", {}, std::move(help));
    option.take = [name = option.name(), &variable](const std::string& text) {
        variable = integers_in<4>(text, ',', name, "x0,y0,x1,y1");
    };
}

void Options::threads(int& variable) {
    integer("--threads", "N", variable, 0, 1024, "threads to use; 0, the default: all");
}

void Options::confine() {
    Option& option = all_.emplace_back();
    option.names = "--confine";
    option.help = "refuse scenes that read files outside their own folder";
    option.take = [](const std::string&) { confine_inputs(); };
}

void Options::messages(bool& quiet, ProgressForm& progress) {
    Option& silence = all_.emplace_back();
    silence.names = "--quiet";
    silence.help = "print nothing but warnings and errors";
    silence.take = [&](const std::string&) {
        quiet = true;
        if (progress == ProgressForm::text) progress = ProgressForm::none;
    };
    Option& form = parsed(
        "--progress", "FORM",
        [&](const std::string& text) {
            if (text != "text" && text != "json")
                throw UsageError(
                    fmt::format("--progress {}: expected text or json", printable(text)));
            progress = text == "json" ? ProgressForm::json : ProgressForm::text;
        },
        "how progress is shown: text, or json: lines for programs, with --quiet as well");
    form.value = Option::Value::word;
    form.words = {"text", "json"};
}

namespace {

std::string suggested_among(const std::string& word, const std::vector<std::string>& names) {
    return suggestion(word, std::vector<std::string_view>(names.begin(), names.end()));
}

/// A command as CLI11 parses it.
struct ParsedCommand {
    const Command* command;
    CLI::App* app;
    std::vector<CLI::Option*> options;  // in the order of command->options

    /// Passes the texts given to their options. Not done in CLI11's own callbacks, which run before
    /// it knows whether help is requested.
    void take() const {
        std::size_t i = 0;
        for (const Option& option : command->options.all()) {
            const CLI::Option& given = *options[i++];
            if (given.count() == 0) continue;
            if (option.is_flag()) {
                option.take({});
                continue;
            }
            for (const std::string& text : given.results()) {
                // `-o ''`: most likely an unset variable in a script.
                if (text.empty())
                    throw UsageError(fmt::format(
                        "{}: has an empty value; give one, or leave it out", option.name()));
                option.take(text);
            }
        }
    }
};

ParsedCommand add_command(CLI::App& program, const Command& command) {
    ParsedCommand parsed{&command, program.add_subcommand(command.name, command.summary), {}};
    parsed.app->footer(command.examples);
    for (const Option& option : command.options.all()) {
        CLI::Option* added = nullptr;
        if (option.is_flag()) {
            added = parsed.app->add_flag(option.names, option.help);
        } else {
            added = parsed.app->add_option(
                option.names, [](const CLI::results_t&) { return true; }, option.help);
            added->type_name(option.value_name)->required(option.required);
            if (option.repeatable) added->take_all()->type_size(1)->allow_extra_args(false);
        }
        if (!option.needs.empty()) added->needs(option.needs);
        parsed.options.push_back(added);
    }
    return parsed;
}

// One line about the first word that neither the program nor its command recognises.
std::string about_unexpected(const CLI::App& program, const ParsedCommand* chosen,
                             std::span<const Command> commands) {
    const std::vector<std::string> words = program.remaining(true);
    const bool is_command = chosen == nullptr && !words.empty() && !words[0].starts_with('-');
    const auto option = std::ranges::find_if(
        words, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
    if (option != words.end() && !is_command) {
        std::vector<std::string> names;
        for (const CLI::Option* known : (chosen != nullptr ? *chosen->app : program).get_options())
            for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
        const std::string word = option->substr(0, option->find('='));
        return fmt::format("{}: unknown option; {}", printable(word), suggested_among(word, names));
    }
    const std::string word = words.empty() ? "" : words.front();
    if (chosen != nullptr)
        return fmt::format("'{}': not expected; see 'uwvdb {} --help'", printable(word),
                           chosen->command->name);
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.name);
    return fmt::format("'{}': unknown command; {}", printable(word), suggested_among(word, names));
}

std::string which_command(std::span<const Command> commands) {
    std::string names;
    for (const Command& command : commands) {
        std::string argument;
        for (const Option& option : command.options.all())
            if (option.is_positional() && option.required) argument += " " + option.names;
        names += fmt::format("'uwvdb {}{}', ", command.name, argument);
    }
    return fmt::format("which command? {}or --help", names);
}

std::function<ExitCode()> printing(std::string text) {
    return [text = std::move(text)] {
        print_output(text);
        return k_exit_done;
    };
}

}  // namespace

std::function<ExitCode()> read_command_line(int argc, const char* const* argv,
                                            std::span<const Command> commands) {
    CLI::App program("uwvdb: physically exact images of lamp-lit water, plumes and what is in them",
                     "uwvdb");
    bool version = false;
    program.add_flag("--version", version,
                     "print the version, and what it was built with, and exit");
    program.footer(
        "Example:\n  uwvdb render assets/scenes/plume.yaml -o plume.exr\n\n"
        "See `uwvdb render --help` and so on for more.");
    std::vector<ParsedCommand> parsed;
    for (const Command& command : commands) parsed.push_back(add_command(program, command));
    const auto chosen = [&]() -> const ParsedCommand* {
        const auto found = std::ranges::find_if(
            parsed, [](const ParsedCommand& command) { return command.app->parsed(); });
        return found == parsed.end() ? nullptr : &*found;
    };
    try {
        program.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        if (chosen() == nullptr && !program.remaining(true).empty())
            throw UsageError(about_unexpected(program, nullptr, commands));
        return printing(chosen() == nullptr ? program.help() : chosen()->app->help("uwvdb"));
    } catch (const CLI::ExtrasError&) {
        throw UsageError(about_unexpected(program, chosen(), commands));
    } catch (const CLI::ParseError& error) {
        const std::string name = chosen() == nullptr ? "" : chosen()->command->name + " ";
        throw UsageError(fmt::format("{}; see 'uwvdb {}--help'", error.what(), name));
    }
    if (version)
        return printing(
            fmt::format("uwvdb {}\nbuilt with {}\n", program_version(), build_libraries()));
    if (chosen() == nullptr) throw UsageError(which_command(commands));
    chosen()->take();
    return chosen()->command->run;
}

}  // namespace uw
