#pragma once
// A material as words of the command material.set.
#include <string>
#include <vector>

#include "commands/document.h"

namespace lucerna::commands {

/// "color=0.5,0.5,0.5 metallic=1 ...": after `like=plain` these words make a material like it. Of its
/// textures only those from files are in them.
std::string material_words(const Document::Material& material);

/// A material that comes with the program, or that a user has kept.
struct Swatch {
  std::string name, words;  ///< material_words()
};
/// Those of the program: plaster, woods, stones, metals, glasses.
const std::vector<Swatch>& swatches();

}  // namespace lucerna::commands
