#include "cli/shell/manual_page.h"

#include <fmt/format.h>

#include <string_view>

#include "core/base/version.h"

namespace uw {

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

}  // namespace uw
