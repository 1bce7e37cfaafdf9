#pragma once

namespace uw {

/// Lets Ctrl-C (SIGINT, SIGTERM) end the program at once with exit code 130 and a line that says
/// so: right for as long as nothing is being written.
void install_stop_signal();

/// From now on Ctrl-C asks for an orderly stop, which stop_requested() tells of; a second one ends
/// the program at once.
void begin_orderly_stop();

/// Whether an orderly stop has been asked for.
bool stop_requested();

}  // namespace uw
