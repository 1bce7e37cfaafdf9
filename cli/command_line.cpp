#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "cli/console.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/version.h"

namespace uw {

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
    const auto option = std::ranges::find_if(
        words, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
    if (option != words.end()) {
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
    program.add_flag("--version", version, "print the version and exit");
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
        return printing(chosen() == nullptr ? program.help() : chosen()->app->help("uwvdb"));
    } catch (const CLI::ExtrasError&) {
        throw UsageError(about_unexpected(program, chosen(), commands));
    } catch (const CLI::ParseError& error) {
        const std::string name = chosen() == nullptr ? "" : chosen()->command->name + " ";
        throw UsageError(fmt::format("{}; see 'uwvdb {}--help'", error.what(), name));
    }
    if (version) return printing("uwvdb " + program_version() + "\n");
    if (chosen() == nullptr) throw UsageError(which_command(commands));
    chosen()->take();
    return chosen()->command->run;
}

}  // namespace uw
