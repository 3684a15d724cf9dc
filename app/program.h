#pragma once
// The whole program behind main(), so that another main() can register solvers first (solvers/registry.h).

namespace lucerna::app {

/// Runs a command line; an error is printed as one line. Returns the exit status.
int run(int argc, char** argv);

}  // namespace lucerna::app
