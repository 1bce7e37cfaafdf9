#include "cli/shell/completion_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "cli/console.h"
#include "cli/shell/completion_script.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

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

}  // namespace uw
