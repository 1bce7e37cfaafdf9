#include "cli/tools/edit_command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/console.h"
#include "cli/process.h"
#include "core/base/available_memory.h"
#include "edit/server/edit_server.h"
#include "edit/session/edit_session.h"

namespace uw {

namespace {

struct EditArguments {
    std::filesystem::path scene;
    int port = 0;
    bool no_browser = false;
    bool published = false;
};

bool has_desktop() {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
        const char* value = std::getenv(name);
        if (value && *value) return true;
    }
    return false;
}

// In a process of its own, without our streams: browsers are talkative.
void open_browser(const std::string& address) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
    // Our Ctrl-C is held (hold_stop_signal), not the browser's.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    std::string program = "xdg-open", argument = address;
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    pid_t process = 0;
    const MemoryLimitLifted lifted;
    const int failure =
        posix_spawnp(&process, program.c_str(), &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) print_message("no browser was found; open this address in one\n");
}

// Pictures of many megabytes are allocated and freed on many threads for hours. By default, glibc
// keeps freed memory in an arena per thread, so that the process would grow as long as lamps are
// dragged.
void return_large_memory() {
    constexpr int k_large_bytes = 1 << 20, k_max_arenas = 4;
    mallopt(M_MMAP_THRESHOLD, k_large_bytes);
    mallopt(M_ARENA_MAX, k_max_arenas);
}

ExitCode run_edit(const EditArguments& a) {
    return_large_memory();
    hold_stop_signal();
    EditSession session(a.scene);
    const EditServer server(session, a.port,
                            a.published ? EditAddress::everywhere : EditAddress::this_machine);
    print_output(fmt::format("{}\n", server.address()));
    if (!a.no_browser && has_desktop()) open_browser(server.address());
    wait_for_stop_signal();
    return k_exit_done;
}

constexpr const char* k_edit_examples = R"(Examples:
  uwvdb edit assets/scenes/plume.yaml
  uwvdb edit rig.yaml --port 8080 --no-browser

Prints the address of a page that shows the scene, on this machine alone, and opens it in a browser
where there is a desktop. Drag lamps, see the picture and its numbers change, save. Ends with Ctrl-C;
what has not been saved is lost.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 4 cannot read the scene, or the port is taken.)";

Options edit_options(EditArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "the scene file").required = true;
    options.integer("--port", "N", a.port, 0, 65535, "listen there; default 0: any free port");
    options.flag("--no-browser", a.no_browser, "print the address only");
    options
        .flag("--published", a.published,
              "listen on all addresses, in a container whose port is published on 127.0.0.1 under "
              "the same number")
        .needs = "--port";
    options.confine();
    return options;
}

}  // namespace

Command edit_command() {
    const auto arguments = std::make_shared<EditArguments>();
    return {"edit", "place the lamps of a scene in a browser and see the water answer",
            k_edit_examples, edit_options(*arguments),
            [arguments] { return run_edit(*arguments); }};
}

}  // namespace uw
