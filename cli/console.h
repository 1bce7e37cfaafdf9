#pragma once

#include <string_view>

namespace uw {

/// To be called first: opens whichever of stdin, stdout and stderr the caller has closed, or the
/// first files opened would take their place and receive our messages; and has an exceeded file
/// size limit reported as a failed write instead of ending the program.
void prepare_streams();

/// Writes to stderr. Failure is ignored: it is no reason to end an hour's work.
void print_message(std::string_view text);

/// Writes to stdout and flushes it. Throws IoError.
void print_output(std::string_view text);

}  // namespace uw
