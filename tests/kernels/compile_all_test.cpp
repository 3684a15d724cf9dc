// links: gpu
// Every kernel compiles, in the leanest and in the fullest variant that a scene can call for.
#include <catch2/catch.hpp>
#include <filesystem>

#include "gpu/kernel.h"

using namespace lucerna;

TEST_CASE("every kernel compiles with nothing and with everything in the scene") {
  gpu::ShaderCompiler compiler(std::filesystem::path(LUCERNA_SOURCE_DIR) / "shaders");
  compiler.set_cache(false);
  const char* effects[] = {"LUCERNA_LIGHTS",
                           "LUCERNA_EMISSIVE",
                           "LUCERNA_ENVIRONMENT_MAP",
                           "LUCERNA_SKY_APART",
                           "LUCERNA_SUN",
                           "LUCERNA_SPECULAR",
                           "LUCERNA_SOLID_GLASS",
                           "LUCERNA_THIN_GLASS",
                           "LUCERNA_DIFFUSE_TRANSMISSION",
                           "LUCERNA_VOLUMES",
                           "LUCERNA_UNLIT",
                           "LUCERNA_ALPHA",
                           "LUCERNA_TRANSPARENT",
                           "LUCERNA_NORMAL_MAPS",
                           "LUCERNA_VERTEX_EXTRA",
                           "LUCERNA_FILM_IMAGES",
                           "LUCERNA_VERTEX_COUNT",
                           "LUCERNA_STOPPING_ONLY",
                           "LUCERNA_SORT_WIDE",
                           "LUCERNA_OCTREE_SINGLE",
                           "LUCERNA_COPIES",
                           "LUCERNA_FROM_SCREEN",
                           "LUCERNA_UV_TRANSFORMS",
                           "LUCERNA_TEX_NEAREST",
                           "LUCERNA_TEX_WRAPS",
                           "LUCERNA_TEX_BASE",
                           "LUCERNA_TEX_METALLIC_ROUGHNESS",
                           "LUCERNA_TEX_EMISSION",
                           "LUCERNA_TEX_SPECULAR",
                           "LUCERNA_TEX_TRANSMISSION",
                           "LUCERNA_TEX_DIFFUSE_TRANSMISSION"};
  const char* uses[] = {"BASE",           "METALLIC_ROUGHNESS", "NORMAL",    "EMISSION",       "SPECULAR",
                        "SPECULAR_COLOR", "TRANSMISSION",       "DIFFUSE_T", "DIFFUSE_T_COLOR"};
  size_t kernels = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(compiler.root())) {
    if (entry.path().extension() != ".comp") continue;
    const std::string file = std::filesystem::relative(entry.path(), compiler.root()).string();
    ++kernels;
    for (const char* on : {"0", "1"}) {
      gpu::Defines defines{{"LUCERNA_BUCKETS", on[0] == '1' ? "6" : "0"},
                           {"LUCERNA_QUERY", on},
                           {"LUCERNA_COHERENT", on[0] == '1' ? "4" : "0"},
                           {"LUCERNA_CACHE", on},
                           {"LUCERNA_CACHE_PARTS", "15u"},
                           {"LUCERNA_CACHE_ELLIPSES", on},
                           {"LUCERNA_NEIGHBOURS", on[0] == '1' ? "27" : "0"}};
      for (const char* use : uses) defines["LUCERNA_" + std::string(use) + "_BUCKETS"] = "63u";
      for (const char* effect : effects) defines[effect] = on;
      INFO(file << " with everything " << on);
      CHECK_NOTHROW(compiler.compile(file, defines));
    }
  }
  CHECK(kernels >= 6);
}
