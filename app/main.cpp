// The program: the viewer, or a batch verb.
#include "app/program.h"

int main(int argc, char** argv) { return lucerna::app::run(argc, argv); }
