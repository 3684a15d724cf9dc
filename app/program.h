#pragma once
// The whole program behind main(), so that another main() may add solvers of its own first
// (solvers/registry.h).

namespace lucerna::app {

/// Carries out a command line; what goes wrong is printed as one line. Returns the exit status.
int run(int argc, char** argv);

}  // namespace lucerna::app
