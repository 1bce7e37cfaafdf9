#include "cli/info/fault_report.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "cli/console.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "render/image_scene.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// `text` with "~" for the user's folder, to protect privacy.
std::string without_home(std::string text) {
    const char* const home = std::getenv("HOME");
    const std::string_view folder = home != nullptr ? home : "";
    if (folder.size() < 2) return text;
    for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos; ++at) {
        const std::size_t end = at + folder.size();
        if (end == text.size() || std::string_view("/\n'\" ").find(text[end]) != std::string::npos)
            text.replace(at, folder.size(), "~");
    }
    return text;
}

/// The lines of `text` indented, without control characters and with the ends of long ones cut off:
/// data in a scene may be megabytes.
std::string indented(std::string_view text) {
    constexpr std::size_t k_longest_line = 300;
    std::string lines;
    while (!text.empty())
        lines += fmt::format("    {}\n", printable(take_line(text), k_longest_line));
    return lines;
}

void print_part(std::string_view heading, std::string_view text) {
    print_output(without_home(fmt::format("{}\n{}", heading, indented(text))));
}

/// What follows the first line of a file that begins with `key`, without what separates them.
std::string value_in(const char* file, std::string_view key) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(key)) continue;
        const std::size_t begin = line.find_first_not_of("\t :=\"", key.size());
        const std::size_t end = line.find_last_not_of("\" ");
        return begin == std::string::npos ? "" : line.substr(begin, end + 1 - begin);
    }
    return "unknown";
}

std::string system_text() {
    utsname kernel{};
    uname(&kernel);
    return fmt::format("{}, {} {} {}, glibc {}", value_in("/etc/os-release", "PRETTY_NAME"),
                       kernel.sysname, kernel.release, kernel.machine, gnu_get_libc_version());
}

std::string processor_text() {
    cpu_set_t permitted;
    CPU_ZERO(&permitted);
    const bool known = sched_getaffinity(0, sizeof permitted, &permitted) == 0;
    std::string level;
#if defined(__x86_64__)
    level = __builtin_cpu_supports("avx512f")  ? ", AVX-512"
            : __builtin_cpu_supports("avx2")   ? ", AVX2"
            : __builtin_cpu_supports("sse4.2") ? ", SSE4.2"
                                               : ", without SSE4.2";
#endif
    return fmt::format("{}, {} of {} processors{}", value_in("/proc/cpuinfo", "model name"),
                       known ? std::to_string(CPU_COUNT(&permitted)) : "?",
                       sysconf(_SC_NPROCESSORS_ONLN), level);
}

std::string memory_text() {
    const double all =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    const double free = static_cast<double>(available_memory_bytes());
    return fmt::format("{:.1f} GB of memory, {:.1f} GB available", all / 1e9,
                       std::min(all, free) / 1e9);
}

/// Settings that change which libraries are loaded, how they work, or what text means.
std::string environment_text() {
    constexpr std::array k_names{"LD_LIBRARY_PATH", "LD_PRELOAD", "MALLOC_ARENA_MAX",
                                 "LC_ALL",          "LANG",       "TMPDIR",
                                 "PYTHONPATH"};
    std::string text;
    for (const char* name : k_names)
        if (const char* const value = std::getenv(name); value != nullptr)
            text += fmt::format("{}{}={}", text.empty() ? "" : ", ", name, value);
    return text.empty() ? "no settings of the environment that matter" : text;
}

/// The program and the libraries that are loaded now, as files.
std::string loaded_files() {
    std::set<std::string> files;
    const auto add = [](dl_phdr_info* object, std::size_t /*size*/, void* set) {
        std::error_code unknown;
        const std::string name = *object->dlpi_name != '\0' ? object->dlpi_name : "/proc/self/exe";
        if (const fs::path file = fs::canonical(name, unknown); !unknown)
            static_cast<std::set<std::string>*>(set)->insert(file.string());
        return 0;
    };
    dl_iterate_phdr(add, &files);
    return fmt::format("{}\n", fmt::join(files, "\n"));
}

std::string file_line(const fs::path& file, std::string_view what) {
    const std::optional<FileStamp> stamp = stamp_of(file);
    const std::string size = stamp ? fmt::format("{} bytes", stamp->bytes) : "missing";
    return fmt::format("{}: {}, {}\n", file.string(), what, size);
}

/// Each file from which the scene is read, or why these are not known.
std::string scene_files(const FaultReportOf& of) {
    try {
        SideFiles side_files;
        std::string text;
        for (const InputFile& input :
             input_files(load_scene(of.subject, of.overrides), {}, side_files))
            text += file_line(input.file, input.what);
        return text;
    } catch (const std::exception&) {
        return "unknown, since the scene cannot be read\n";
    }
}

std::string scene_text(const fs::path& file) {
    constexpr std::size_t k_max_bytes = 64 << 20;
    try {
        return read_text_file(file, file.filename().string(), k_max_bytes, "scene");
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace

void print_fault_report(const FaultReportOf& of) {
    print_output(fmt::format("uwvdb {}\n", program_version()));
    print_part("Built with", build_libraries());
    print_part("Machine", fmt::format("{}\n{}\n{}\n{}", system_text(), processor_text(),
                                      memory_text(), environment_text()));
    print_part("Loaded", loaded_files());
    if (of.subject.empty()) return;
    if (of.is_scene) {
        print_part(fmt::format("Scene {}", printable(of.subject.string(), 300)),
                   scene_text(of.subject));
        if (!of.overrides.empty())
            print_part("--set", fmt::format("{}", fmt::join(of.overrides, "\n")));
        print_part("Files", scene_files(of));
    } else {
        print_part("File", file_line(of.subject, "a volume"));
    }
    try {
        print_part("Log", of.log());
    } catch (const std::exception& error) {
        print_part("Log", fmt::format("uwvdb: {}", line_of(error)));
    }
}

}  // namespace uw
