#include <vector>

#include "cli/command.h"
#include "cli/program.h"
#include "cli/render/render_command.h"

// The command `render` as a program of its own, which is built in half the time: scripts/demo
// renders its picture with it while there is no other.
int main(int argc, char** argv) {
    return uw::run_program(argc, argv, [](std::vector<uw::Command>& commands) {
        commands.push_back(uw::render_command());
    });
}
