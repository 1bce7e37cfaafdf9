#include "cli/shell/manual_command.h"

#include "cli/console.h"
#include "cli/shell/manual_page.h"

namespace uw {

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
