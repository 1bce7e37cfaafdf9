#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/error.h"

/// What the fuzzers share. Each reads its input as the program reads a file of that kind: what is
/// wrong with it is an InputError, an IoError or a UsageError of one line. Anything else that it
/// throws, and whatever the sanitizers find, ends the fuzzer.
namespace uw::fuzz {

/// A folder of this process for the files that parsers open by their names.
class InputFolder {
  public:
    InputFolder()
        : folder_(std::filesystem::temp_directory_path() /
                  ("uwvdb-fuzz-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~InputFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    InputFolder(const InputFolder&) = delete;
    InputFolder& operator=(const InputFolder&) = delete;

    /// Replaces the file of this name.
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::filesystem::path file = folder_ / name;
        std::ofstream(file, std::ios::binary)
            .write(content.data(), static_cast<std::streamsize>(content.size()));
        return file;
    }

  private:
    std::filesystem::path folder_;
};

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// A message that users could not read as one line ends the fuzzer, too.
inline void check_message(std::string_view message) {
    if (message.empty() || message.find('\n') != std::string_view::npos) __builtin_trap();
}

template <class Parse>
void parse(const Parse& parse) {
    try {
        parse();
    } catch (const InputError& error) {
        check_message(error.what());
    } catch (const IoError& error) {
        check_message(error.what());
    } catch (const UsageError& error) {
        check_message(error.what());
    }
}

/// The first line of the input, which chooses what the rest is, and the rest.
struct Split {
    std::string_view first, rest;
};
inline Split split_line(std::string_view text) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {text, {}};
    return {text.substr(0, end), text.substr(end + 1)};
}

}  // namespace uw::fuzz

/// The function that libFuzzer calls.
#define UWVDB_FUZZ(data, size) \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
