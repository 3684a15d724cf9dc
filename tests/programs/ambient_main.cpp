// The program with one more solver, unknown to its own files (support/ambient/ambient.h).
#include "app/program.h"
#include "solvers/registry.h"
#include "support/ambient/ambient.h"

int main(int argc, char** argv) {
  lucerna::solvers::add(lucerna::ambient::type());
  return lucerna::app::run(argc, argv);
}
