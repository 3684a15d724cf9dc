// Materials that come with the program. Reflectances of metals: their normal-incidence colours in linear
// Rec.709, as the tables of measured indices of refraction give them (refractiveindex.info); indices of
// liquids and glasses likewise.
#include "commands/material_words.h"

namespace lucerna::commands {

const std::vector<Swatch>& swatches() {
  static const std::vector<Swatch> all{
      {"White plaster", "color=0.8,0.78,0.74 roughness=0.95"},
      {"White paint", "color=0.84,0.84,0.82 roughness=0.5"},
      {"Black paint", "color=0.02,0.02,0.02 roughness=0.4"},
      {"Grey card", "color=0.18,0.18,0.18 roughness=1 specular=0"},
      {"Concrete", "color=0.33,0.32,0.3 roughness=0.85"},
      {"Brick", "color=0.34,0.11,0.06 roughness=0.9"},
      {"Limestone", "color=0.62,0.55,0.42 roughness=0.8"},
      {"Marble, polished", "color=0.83,0.81,0.77 roughness=0.1"},
      {"Slate", "color=0.06,0.07,0.08 roughness=0.6"},
      {"Oak, oiled", "color=0.38,0.21,0.09 roughness=0.55"},
      {"Walnut, varnished", "color=0.12,0.055,0.025 roughness=0.6 clearcoat=1 clearcoat_roughness=0.06"},
      {"Linen", "color=0.6,0.54,0.43 roughness=1 sheen=0.25,0.24,0.22 sheen_roughness=0.5"},
      {"Velvet", "color=0.12,0.01,0.02 roughness=1 sheen=0.6,0.2,0.2 sheen_roughness=0.3"},
      {"Leather", "color=0.09,0.035,0.018 roughness=0.45"},
      {"Rubber", "color=0.025,0.025,0.025 roughness=0.8"},
      {"Porcelain", "color=0.85,0.84,0.8 roughness=0.05"},
      {"Steel, brushed", "color=0.56,0.57,0.58 metallic=1 roughness=0.35 anisotropy=0.7"},
      {"Chrome", "color=0.55,0.556,0.554 metallic=1 roughness=0.02"},
      {"Aluminium", "color=0.912,0.914,0.92 metallic=1 roughness=0.25"},
      {"Copper", "color=0.955,0.638,0.538 metallic=1 roughness=0.2"},
      {"Brass", "color=0.91,0.778,0.423 metallic=1 roughness=0.2"},
      {"Gold", "color=1,0.766,0.336 metallic=1 roughness=0.1"},
      {"Window glass", "color=1,1,1 roughness=0 transmission=1 ior=1.52"},
      {"Frosted pane", "color=1,1,1 roughness=0.4 transmission=1 ior=1.52"},
      {"Solid glass", "color=1,1,1 roughness=0 transmission=1 thickness=1 ior=1.52"},
      {"Green glass",
       "color=1,1,1 roughness=0 transmission=1 thickness=1 ior=1.52 absorb_color=0.3,0.75,0.45 "
       "absorb_distance=0.02"},
      {"Water",
       "color=1,1,1 roughness=0 transmission=1 thickness=1 ior=1.33 absorb_color=0.45,0.8,0.9 "
       "absorb_distance=2"},
      {"Mirror", "color=0.95,0.95,0.95 metallic=1 roughness=0"},
      {"Lampshade",
       "color=0.75,0.68,0.55 roughness=1 diffuse_transmission=0.5 "
       "diffuse_transmission_color=0.8,0.7,0.5"},
      {"Soap film",
       "color=0.5,0.5,0.5 roughness=0 transmission=1 ior=1.33 iridescence=1 film_ior=1.33 "
       "film_thickness=350"},
  };
  return all;
}

}  // namespace lucerna::commands
