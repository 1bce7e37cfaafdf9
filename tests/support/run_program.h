#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace uw::test {

struct ProgramResult {
    int exit_code = -1;  // 128 + signal if a signal ended it
    std::string out, err;
};

struct ProgramOptions {
    std::filesystem::path folder = ".";  // where it runs
    std::filesystem::path program = UWVDB_PROGRAM;
    int terminal_columns = 0;      // above 0: stderr is a terminal of that width
    bool streams_full = false;     // stdout and stderr are /dev/full: no write succeeds
    bool streams_closed = false;   // started without stdin, stdout and stderr
    double timeout_seconds = 300;  // then it is killed, and the test fails
};

/// A running process of the uwvdb that was built with the tests.
class Program {
  public:
    explicit Program(const std::vector<std::string>& arguments, const ProgramOptions& options = {});
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    Program(Program&&) = delete;
    Program& operator=(Program&&) = delete;
    ~Program();

    /// Waits until stderr contains `text`; fails the test if the program ends first.
    void wait_for(const std::string& text);
    void signal(int number) const;
    /// What it has written to stdout so far.
    std::string output() const;
    ProgramResult wait();

  private:
    bool ended();
    void collect_terminal();

    TempDir streams_;
    double deadline_ = 0;
    pid_t process_ = -1;
    int terminal_ = -1;
    int status_ = 0;
    bool ended_ = false;
    std::string terminal_text_;
};

/// Runs the program to its end.
ProgramResult run_program(const std::vector<std::string>& arguments,
                          const ProgramOptions& options = {});

/// How many lines a text has; all of them end with a line break.
int line_count(const std::string& text);

}  // namespace uw::test
