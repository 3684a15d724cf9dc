// links: base
// Scripts of tests/screenshots in a window (each is run without one by the test screenshots.NAME), and what a
// failure leaves.
#include <fmt/format.h>

#include <filesystem>

#include "support.h"

namespace screenshots_tests {

using namespace lucerna;

TEST_CASE("scripts pass in a window, several in one program") {
  if (test::no_program()) return;
  const test::Folder folder;
  std::string command = std::string(LUCERNA_BINARY) + " script";
  for (const char* script : {"dialogs", "errors", "exposure"})
    command += fmt::format(" tests/screenshots/{}.lucerna", script);
  const auto outcome =
      test::run(test::with_display(command + " --device cpu --report " + folder.path.string() + "/report"));
  INFO(outcome.output);
  CHECK(outcome.status == 0);
  CHECK(std::filesystem::exists(folder.path / "report/junit.xml"));
}

TEST_CASE("a broken overlay fails its script, with the pictures and the command to accept") {
  if (test::no_program()) return;
  const test::Folder folder;
  // The script with the pictures of another one.
  for (const char* file : {"components.lucerna", "parts/small.lucerna"}) {
    std::filesystem::create_directories((folder.path / "a/b" / file).parent_path());
    std::filesystem::copy_file(std::string("tests/screenshots/") + file, folder.path / "a/b" / file);
  }
  std::filesystem::create_directory_symlink(std::filesystem::absolute("scenes"), folder.path / "scenes");
  for (const char* component : {"primary", "secondary", "tertiary", "caustic"})
    std::filesystem::copy_file("tests/screenshots/components-primary.png",
                               folder.path / "a/b" / ("components-" + std::string(component) + ".png"));
  const auto outcome = test::run(std::string(LUCERNA_BINARY) + " script --headless " +
                                 (folder.path / "a/b/components.lucerna").string() + " --report " +
                                 (folder.path / "report").string());
  INFO(outcome.output);
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.output, Catch::Contains("3 failed") && Catch::Contains("cp ") &&
                                 Catch::Contains("components.lucerna:7 (component = caustic)"));
  for (const char* file :
       {"report.html", "junit.xml", "1-picture.png", "1-reference.png", "1-difference.png"})
    CHECK(std::filesystem::exists(folder.path / "report" / file));
}

}  // namespace screenshots_tests
