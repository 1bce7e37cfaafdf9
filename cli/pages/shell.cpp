#include "cli/pages/shell.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/console.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/version.h"

namespace uw {

namespace {

using Value = Option::Value;

constexpr std::string_view k_program_options = "--help --version";

/// "-o,--output" as "-o" and "--output".
std::vector<std::string> names_of(const Option& option) {
    const std::size_t comma = option.names.find(',');
    if (comma == std::string::npos) return {option.names};
    return {option.names.substr(0, comma), option.names.substr(comma + 1)};
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos;
         at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

}  // namespace

std::string in_shell_quotes(const std::string& text) {
    return "'" + replaced(text, "'", R"('\'')") + "'";
}

namespace {

std::string names_of(std::span<const Command> commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.name);
    return fmt::format("{}", fmt::join(names, " "));
}

std::string bash_case(const Command& command) {
    std::string cases;
    std::vector<std::string> options{"--help"};
    std::vector<std::string> argument_words;
    for (const Option& option : command.options.all()) {
        if (option.is_positional()) {
            argument_words.insert(argument_words.end(), option.words.begin(), option.words.end());
            continue;
        }
        const std::vector<std::string> names = names_of(option);
        options.insert(options.end(), names.begin(), names.end());
        if (option.is_flag()) continue;
        const char* const candidates = option.is_path()       ? "compgen -f"
                                       : option.words.empty() ? ":"
                                                              : "compgen -W";
        const std::string words =
            option.words.empty() ? "" : fmt::format(" '{}'", fmt::join(option.words, " "));
        cases += fmt::format(
            "                {}) mapfile -t COMPREPLY < <({}{} -- \"$current\"); return ;;\n",
            fmt::join(names, "|"), candidates, words);
    }
    const std::string argument =
        argument_words.empty() ? "compgen -f"
                               : fmt::format("compgen -W '{}'", fmt::join(argument_words, " "));
    return fmt::format(
        "        {})\n"
        "            case $previous in\n{}            esac\n"
        "            if [[ $current == -* ]]; then\n"
        "                mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$current\")\n"
        "            else\n"
        "                mapfile -t COMPREPLY < <({} -- \"$current\")\n"
        "            fi\n"
        "            ;;\n",
        command.name, cases, fmt::join(options, " "), argument);
}

std::string bash_script(std::span<const Command> commands) {
    std::string cases;
    for (const Command& command : commands) cases += bash_case(command);
    return fmt::format(
        "# bash completion for uwvdb\n"
        "_uwvdb() {{\n"
        "    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
        "    COMPREPLY=()\n"
        "    if ((COMP_CWORD == 1)); then\n"
        "        mapfile -t COMPREPLY < <(compgen -W '{} {}' -- \"$current\")\n"
        "        return\n"
        "    fi\n"
        "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
        "}}\n"
        "complete -o filenames -F _uwvdb uwvdb\n",
        names_of(commands), k_program_options, cases);
}

/// An option as _arguments specifies it: '(-o --output)'{-o,--output}'[help]:OUT.exr:_files'.
std::string zsh_specification(const Option& option, int position) {
    const std::string help = replaced(replaced(option.help, "[", R"(\[)"), "]", R"(\])");
    const std::string value_name = replaced(option.value_name, ":", R"(\:)");
    const std::string action = !option.words.empty() && option.value == Value::word
                                   ? fmt::format("({})", fmt::join(option.words, " "))
                               : option.is_path() ? "_files"
                                                  : " ";
    if (option.is_positional())
        return in_shell_quotes(fmt::format("{}:{}:{}", position, option.names,
                                           option.words.empty() ? "_files" : action));
    const std::string value = option.is_flag() ? "" : fmt::format(":{}:{}", value_name, action);
    const std::vector<std::string> names = names_of(option);
    if (names.size() == 1)
        return in_shell_quotes(
            fmt::format("{}{}[{}]{}", option.repeatable ? "*" : "", names.front(), help, value));
    return fmt::format("'({})'{{{}}}{}", fmt::join(names, " "), fmt::join(names, ","),
                       in_shell_quotes(fmt::format("[{}]{}", help, value)));
}

std::string zsh_script(std::span<const Command> commands) {
    std::string summaries, cases;
    for (const Command& command : commands) {
        summaries +=
            fmt::format("        {}\n", in_shell_quotes(command.name + ":" + command.summary));
        cases += fmt::format("        {})\n            _arguments '--help[print help and exit]'",
                             command.name);
        int position = 0;
        for (const Option& option : command.options.all()) {
            if (option.is_positional()) ++position;
            cases += " \\\n                " + zsh_specification(option, position);
        }
        cases += "\n            ;;\n";
    }
    return fmt::format(
        "#compdef uwvdb\n"
        "_uwvdb() {{\n"
        "    local -a commands=(\n{}    )\n"
        "    if ((CURRENT == 2)); then\n"
        "        _describe command commands\n"
        "        compadd -- {}\n"
        "        return\n"
        "    fi\n"
        "    local command=$words[2]\n"
        "    shift words\n"
        "    ((CURRENT--))\n"
        "    case $command in\n{}    esac\n"
        "}}\n"
        "_uwvdb \"$@\"\n",
        summaries, k_program_options, cases);
}

std::string fish_quotes(const std::string& text) {
    return "'" + replaced(replaced(text, R"(\)", R"(\\)"), "'", R"(\')") + "'";
}

std::string fish_script(std::span<const Command> commands) {
    std::string script =
        "# fish completion for uwvdb\n"
        "complete -c uwvdb -n __fish_use_subcommand -f\n"
        "complete -c uwvdb -n __fish_use_subcommand -l help -d 'print help and exit'\n"
        "complete -c uwvdb -n __fish_use_subcommand -l version -d 'print the version and exit'\n";
    for (const Command& command : commands) {
        script += fmt::format("complete -c uwvdb -n __fish_use_subcommand -a {} -d {}\n",
                              command.name, fish_quotes(command.summary));
        const std::string begin =
            fmt::format("complete -c uwvdb -n '__fish_seen_subcommand_from {}'", command.name);
        script += begin + " -l help -d 'print help and exit'\n";
        for (const Option& option : command.options.all()) {
            const std::string words = fmt::format("{}", fmt::join(option.words, " "));
            if (option.is_positional()) {
                if (!words.empty())
                    script += fmt::format("{} -f -a {}\n", begin, fish_quotes(words));
                continue;
            }
            std::string line = begin;
            for (const std::string& name : names_of(option))
                line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            if (option.is_path()) line += " -r -F";
            if (option.value == Value::text) line += " -x";
            if (!words.empty()) line += " -x -a " + fish_quotes(words);
            script += line + " -d " + fish_quotes(option.help) + "\n";
        }
    }
    return script;
}

}  // namespace

std::string completion_script(std::string_view shell, std::span<const Command> commands) {
    if (shell == "zsh") return zsh_script(commands);
    if (shell == "fish") return fish_script(commands);
    return bash_script(commands);
}

namespace {

constexpr const char* k_completion_examples = R"(Examples:
  source <(uwvdb completion bash)                                  in this shell
  uwvdb completion bash > ~/.local/share/bash-completion/completions/uwvdb
  uwvdb completion zsh > ~/.zfunc/_uwvdb                           a folder of $fpath
  uwvdb completion fish > ~/.config/fish/completions/uwvdb.fish

An installed package brings them along.
Exit codes: 0 done, 2 wrong usage, 4 cannot write.)";

}  // namespace

Command completion_command(const std::vector<Command>& commands) {
    const auto shell = std::make_shared<std::string>();
    Options options;
    Option& argument = options.parsed(
        "SHELL", "",
        [shell](const std::string& word) {
            if (std::ranges::find(k_shells, word) == k_shells.end())
                throw UsageError(fmt::format("'{}': unknown shell; {}", printable(word),
                                             suggestion(word, k_shells)));
            *shell = word;
        },
        "bash, zsh or fish");
    argument.value = Option::Value::word;
    argument.required = true;
    argument.words.assign(k_shells.begin(), k_shells.end());
    return {"completion", "print a script that completes uwvdb's words in a shell",
            k_completion_examples, std::move(options), [shell, &commands] {
                print_output(completion_script(*shell, commands));
                return k_exit_done;
            }};
}

namespace {

/// Text as roff: special characters are escaped, also at the beginning of a line.
std::string roff(std::string_view text) {
    std::string out;
    bool line_begins = true;
    for (const char c : text) {
        if (line_begins && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        line_begins = c == '\n';
    }
    return out;
}

std::string synopsis(const Command& command) {
    std::string line = fmt::format(".B uwvdb {}\n[\\fIOPTIONS\\fR]", roff(command.name));
    for (const Option& option : command.options.all())
        if (option.is_positional())
            line += fmt::format("{}\\fI{}\\fR{}", option.required ? " " : " [", roff(option.names),
                                option.required ? "" : "]");
    return line;
}

std::string described(const Option& option) {
    const std::string value =
        option.value_name.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(option.value_name));
    const char font = option.is_positional() ? 'I' : 'B';
    return fmt::format(".TP\n\\f{}{}\\fR{}\n{}\n", font, roff(option.names), value,
                       roff(option.help));
}

}  // namespace

std::string manual_page(std::span<const Command> commands) {
    std::string page = fmt::format(
        ".TH UWVDB 1 \"\" \"uwvdb {}\" \"User Commands\"\n"
        ".SH NAME\nuwvdb \\- physically exact images of lamp\\-lit water, plumes and what is in "
        "them\n.SH SYNOPSIS\n",
        roff(program_version()));
    for (const Command& command : commands)
        page += (&command == &commands.front() ? "" : "\n.br\n") + synopsis(command);
    page += "\n.SH COMMANDS\n";
    for (const Command& command : commands) {
        page += fmt::format(".SS {}\n{}.\n", roff(command.name), roff(command.summary));
        for (const Option& option : command.options.all()) page += described(option);
        page += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(command.examples));
    }
    page += ".SH EXIT STATUS\n";
    for (const auto& [code, meaning] : k_exit_meanings)
        page += fmt::format(".TP\n.B {}\n{}\n", static_cast<int>(code), roff(meaning));
    return page;
}

Command manual_command(const std::vector<Command>& commands) {
    return {"man",
            "print the manual page of all commands",
            "Examples:\n  uwvdb man | man -l -\n\nExit codes: 0 done, 4 cannot write.",
            {},
            [&commands] {
                print_output(manual_page(commands));
                return k_exit_done;
            }};
}

}  // namespace uw
