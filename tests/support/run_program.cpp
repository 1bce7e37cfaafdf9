#include "tests/support/run_program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace uw::test {

namespace {

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

int open_for_writing(const std::filesystem::path& file) {
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (opened < 0) throw std::runtime_error("cannot open " + file.string());
    return opened;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const ProgramOptions& options)
    : deadline_(now() + options.timeout_seconds) {
    std::vector<std::string> words{options.program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    const int out = open_for_writing(streams_ / "out");
    int err = -1;
    if (options.terminal_columns > 0) {
        winsize size{};
        size.ws_row = 25;
        size.ws_col = static_cast<unsigned short>(options.terminal_columns);
        if (::openpty(&terminal_, &err, nullptr, nullptr, &size) != 0)
            throw std::runtime_error("no pseudo terminal");
        ::fcntl(terminal_, F_SETFL, O_NONBLOCK);
        ::fcntl(terminal_, F_SETFD, FD_CLOEXEC);
    } else {
        err = open_for_writing(streams_ / "err");
    }
    process_ = ::fork();
    if (process_ < 0) throw std::runtime_error("fork failed");
    if (process_ == 0) {
        if (::chdir(options.folder.c_str()) != 0) ::_exit(126);
        const int full = options.streams_full ? ::open("/dev/full", O_WRONLY | O_CLOEXEC) : -1;
        ::dup2(options.streams_full ? full : out, STDOUT_FILENO);
        ::dup2(options.streams_full ? full : err, STDERR_FILENO);
        if (options.streams_closed)
            for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::close(stream);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ::close(out);
    ::close(err);
}

Program::~Program() {
    if (!ended()) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, &status_, 0);
    }
    if (terminal_ >= 0) ::close(terminal_);
}

void Program::collect_terminal() {
    if (terminal_ < 0) return;
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t count = ::read(terminal_, buffer.data(), buffer.size());
        if (count <= 0) return;
        terminal_text_.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

bool Program::ended() {
    collect_terminal();
    if (!ended_) ended_ = ::waitpid(process_, &status_, WNOHANG) == process_;
    if (!ended_ && now() > deadline_) {
        ADD_FAILURE() << "the program was killed: it did not end in time";
        ::kill(process_, SIGKILL);
        ended_ = ::waitpid(process_, &status_, 0) == process_;
    }
    return ended_;
}

void Program::wait_for(const std::string& text) {
    while (text_of(streams_ / "err").find(text) == std::string::npos) {
        if (ended()) {
            ADD_FAILURE() << "the program ended without '" << text << "'";
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

void Program::signal(int number) const {
    if (!ended_) ::kill(process_, number);
}

std::string Program::output() const {
    return text_of(streams_ / "out");
}

ProgramResult Program::wait() {
    while (!ended()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    collect_terminal();
    ProgramResult result;
    result.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    result.out = text_of(streams_ / "out");
    result.err = terminal_ >= 0 ? terminal_text_ : text_of(streams_ / "err");
    return result;
}

ProgramResult run_program(const std::vector<std::string>& arguments,
                          const ProgramOptions& options) {
    return Program(arguments, options).wait();
}

int line_count(const std::string& text) {
    return static_cast<int>(std::ranges::count(text, '\n'));
}

}  // namespace uw::test
