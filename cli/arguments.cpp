#include "cli/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "cli/command_options.h"
#include "cli/version.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

std::vector<std::string> names_of_options(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// One line about the first word that neither `app` nor its command could place.
std::string about_unexpected(const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    const std::vector<std::string> words = app.remaining(true);
    const auto option = std::ranges::find_if(
        words, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
    if (option != words.end()) {
        const std::vector<std::string> names =
            names_of_options(commands.empty() ? app : *commands.front());
        const std::string word = option->substr(0, option->find('='));
        return fmt::format(
            "{}: unknown option; {}", printable(word),
            suggestion(word, std::vector<std::string_view>(names.begin(), names.end())));
    }
    const std::string word = words.empty() ? "" : words.front();
    if (!commands.empty())
        return fmt::format("'{}': not expected; give one SCENE, and options", printable(word));
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return fmt::format("'{}': unknown command; {}", printable(word),
                       suggestion(word, std::vector<std::string_view>(names.begin(), names.end())));
}

// Refuses `-o ''`: most likely a variable of a script that was not set.
void refuse_empty_files(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0 || option->get_type_size() == 0) continue;
        for (const std::string& text : option->results())
            if (text.empty())
                throw UsageError(
                    fmt::format("{}: has an empty value; give one, or leave it out",
                                option->get_positional() ? "SCENE" : option->get_name()));
    }
}

}  // namespace

CLI::Validator in_range(int low, int high) {
    return CLI::Validator(
        [low, high](const std::string& text) -> std::string {
            int value = 0;
            const char* const end = text.data() + text.size();
            const auto [next, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc() && next == end && value >= low && value <= high) return {};
            return fmt::format("expected {} to {}, found '{}'", low, high, printable(text));
        },
        "");
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
    command.add_option("--set", overrides, "replace a value of the scene file; may be repeated")
        ->take_all()
        ->type_name("KEY.PATH=VALUE")
        ->type_size(1)
        ->allow_extra_args(false);
}

void add_threads_option(CLI::App& command, int& threads) {
    command.add_option("--threads", threads, "threads to use; 0, the default: all there are")
        ->check(in_range(0, 1024))
        ->type_name("N");
}

Arguments parse_arguments(int argc, const char* const* argv) {
    CLI::App app("uwvdb: physically exact images of lamp-lit water, plumes and what is in them",
                 "uwvdb");
    bool version = false;
    app.add_flag("--version", version, "print the version and stop");
    app.footer(
        "Example:\n  uwvdb render assets/scenes/plume.yaml -o plume.exr\n\n"
        "`uwvdb render --help` and so on tell more.");
    const std::array commands = {add_render_command(app), add_info_command(app),
                                 add_water_command(app), add_validate_command(app),
                                 add_calibration_command(app)};
    const auto chosen = [&] {
        return std::ranges::find_if(commands, [](const Command& c) { return c.app->parsed(); });
    };
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return MessageArguments{chosen() == commands.end() ? app.help()
                                                           : chosen()->app->help("uwvdb")};
    } catch (const CLI::ExtrasError&) {
        throw UsageError(about_unexpected(app));
    } catch (const CLI::ParseError& error) {
        const std::string name = chosen() == commands.end() ? "" : chosen()->app->get_name() + " ";
        throw UsageError(fmt::format("{}; see 'uwvdb {}--help'", error.what(), name));
    }
    if (version) return MessageArguments{"uwvdb " + program_version() + "\n"};
    if (chosen() == commands.end())
        throw UsageError(
            "which command? 'uwvdb render SCENE', 'uwvdb info FILE.vdb|SCENE', 'uwvdb water', "
            "'uwvdb validate', 'uwvdb calibration FILE', or --help");
    refuse_empty_files(*chosen()->app);
    return chosen()->finish();
}

}  // namespace uw
