#pragma once
// Saves a session as a test: a script that opens the scene, repeats what was done, and expects the present
// picture, which is stored beside it.
#include <string>

namespace lucerna::commands {

class Workspace;

/// The name of the picture beside a script.
std::string test_picture(const std::string& script);

/// The lines of the script `file`. Files are named relative to its folder if they are on the same disk; lines
/// that write files are left out. Throws Error: no scene is open, or the picture has fewer than two samples.
std::string session_test(const Workspace& work, const std::string& file);

/// Writes script and picture; the picture follows when the session has written it. Throws Error like
/// session_test(), or if a file exists that is none of a saved test.
void save_test(Workspace& work, const std::string& file);

}  // namespace lucerna::commands
