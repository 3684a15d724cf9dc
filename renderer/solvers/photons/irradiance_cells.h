#pragma once
// Irradiance of surface cells from the photons on them: radiosity textures as fine as the photon density
// permits (P. S. Heckbert, "Adaptive Radiosity Textures for Bidirectional Ray Tracing", 1990).
//
// Each side of a triangle is split into four, recursively, while each quarter has enough photons. Sides of
// small triangles with too few photons are merged with nearby sides of similar orientation. The irradiance of
// a cell is its photons' flux over its known area: no discs, no borders, no light of other surfaces. One half
// of the photons determines the cells, the other half their light, so that the light of a cell is independent
// of its choice. Cells with too few photons even after merging have no data.
#include <compare>
#include <span>
#include <vector>

#include "shaders/shared/photons/irradiance.h"
#include "upload/flatten.h"

namespace lucerna::photons {

/// Triangle sides that may get irradiance, ordered so that nearby sides of similar orientation are adjacent.
/// Partly transparent triangles are excluded, because their area is unknown.
struct SideOrder {
  /// The orientation of a side, then its centre's Morton code, the lower half of it in `low`. The code's
  /// cubes are aligned to the world's origin, so that distant geometry does not change them, and its bits per
  /// axis make them small everywhere.
  struct Key {
    uint64_t high = 0, low = 0;
    friend bool operator==(const Key&, const Key&) = default;
    friend auto operator<=>(const Key&, const Key&) = default;
    Key above(int bit) const { return bit >= 48 ? Key{high >> (bit - 48), 0} : Key{high, low >> bit}; }
  };
  std::vector<uint32_t> sides;   ///< triangle << 1, plus 1 for its back
  std::vector<Key> keys;         ///< rising
  std::vector<float> areas;      ///< [m^2], per triangle
  std::vector<float> longest;    ///< longest edge of each triangle [m]
  std::vector<uint32_t> places;  ///< per side: position in `sides`; k_no_place: none
  float across = 1;              ///< width of the cube of the Morton codes [m]
};
inline constexpr uint32_t k_no_place = ~0u;
/// `diffuse`: by material.
SideOrder order_sides(const upload::FlatScene& flat, const std::vector<bool>& diffuse);

struct PhotonOnSide {
  uint32_t side = 0, barycentric = 0;  ///< as shared::PhotonSurface
  uint32_t number = 0;                 ///< unique number, k_photon_id_events
  uint32_t group = 0;                  ///< light group, if groups are separate
  vec3 flux{0};                        ///< [W], of all photons
};

/// Two maps, lit by different halves of the photons.
struct IrradianceCells {
  std::vector<uvec4> roots;  ///< per triangle: nodes of front and back in the first map, then in the second
  std::vector<vec4> nodes;   ///< shared/photons/irradiance.h, 1 + groups texels each
  uint32_t known = 0;        ///< number of cells with data
};

class IrradianceCellsBuilder {
 public:
  /// `order` outlives it. `groups`: number of separate light groups; 0: none. `nearest`: minimum photons of a
  /// half per cell. `widest`: approximate maximum size of a merged cell [m].
  IrradianceCellsBuilder(const SideOrder& order, std::vector<PhotonOnSide> photons, uint32_t groups,
                         uint32_t nearest, float widest);
  /// Adds the map lit by half 0 or 1 of the photons. Call once for each.
  void add_map(uint32_t lit_by);
  IrradianceCells take() { return std::move(cells_); }

 private:
  struct Sum {
    uint32_t deciding = 0;  ///< number of photons
    double area = 0;
    std::vector<double> flux;  ///< R G B, then by group
    std::vector<uint32_t> nodes;
  };
  struct Rest;
  struct Piece {
    double area = 0, longest = 0;  ///< edge
    uint32_t depth = 0;            ///< number of splits
    double expected = 0;           ///< expected deciding photons, from those of the parent
  };
  void cut(uint32_t node, std::span<PhotonOnSide> photons, const Piece& piece, std::vector<Sum>& found,
           Sum& rest);
  void cluster(uint32_t first, uint32_t last, int bit, Rest& rest);
  void light(const Sum& sum);
  void put(uint32_t node, const Sum& sum);
  uint32_t add_nodes(uint32_t count);
  Sum sum_of(std::span<const PhotonOnSide> photons, double area) const;
  static uint32_t half_of(const PhotonOnSide& p);

  const SideOrder& order_;
  std::vector<PhotonOnSide> photons_;  ///< by side, then by number
  uint32_t groups_, nearest_, lit_by_ = 0;
  double widest_;
  std::vector<uint32_t> rests_of_;  ///< by position in the order: leftovers there, in rests_
  std::vector<Sum> rests_;
  std::vector<uint32_t> decided_;  ///< prefix sum of leftover photons in the order
  IrradianceCells cells_;
};

}  // namespace lucerna::photons
