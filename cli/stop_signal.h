#pragma once

namespace uw {

/// Lets Ctrl-C (SIGINT, SIGTERM) ask for an orderly stop; a second one ends the program at once.
void install_stop_signal();

/// Whether a stop has been asked for.
bool stop_requested();

}  // namespace uw
