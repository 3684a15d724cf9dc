#pragma once
// Irradiance on pieces of surfaces, from the photons that lie on them: radiosity textures that are as fine as
// there are photons (P. S. Heckbert, "Adaptive Radiosity Textures for Bidirectional Ray Tracing", 1990).
//
// Each side of a triangle is cut in four, again and again, as long as each quarter has enough photons; sides
// of small triangles that have too few are put together with those near them that face alike. A piece's
// irradiance is its photons' flux over its area, which is known: there are no discs, no borders and no light
// of other surfaces. Pieces are chosen by one half of the photons and lit by the other, so that what a piece
// has does not hang on why it is one. What has too few photons even together with what lies around stays
// unknown.
#include <compare>
#include <span>
#include <vector>

#include "shaders/shared/photons/irradiance.h"
#include "upload/flatten.h"

namespace lucerna::photons {

/// Sides of triangles on which irradiance is looked for, so that those near each other that face alike stand
/// together. Without what is partly transparent, whose area is not known.
struct SideOrder {
  /// 6 bits which way a side faces, then the 96 of the Morton code of its centre: 48 and 48. The code's cubes
  /// are cut at the world's origin and in halves from there, so that what lies far away cuts no other cubes
  /// here, and 32 bits an axis make them small everywhere.
  struct Key {
    uint64_t high = 0, low = 0;
    friend bool operator==(const Key&, const Key&) = default;
    friend auto operator<=>(const Key&, const Key&) = default;
    Key above(int bit) const { return bit >= 48 ? Key{high >> (bit - 48), 0} : Key{high, low >> bit}; }
  };
  std::vector<uint32_t> sides;   ///< triangle << 1, and 1: its back
  std::vector<Key> keys;         ///< grow
  std::vector<float> areas;      ///< [m^2], a triangle each
  std::vector<float> longest;    ///< edge of a triangle [m]
  std::vector<uint32_t> places;  ///< a side each: where it stands in `sides`; k_no_place: nowhere
  float across = 1;              ///< of the cube that Morton codes are in [m]
};
inline constexpr uint32_t k_no_place = ~0u;
/// `diffuse`: by material.
SideOrder order_sides(const upload::FlatScene& flat, const std::vector<bool>& diffuse);

struct PhotonOnSide {
  uint32_t side = 0, barycentric = 0;  ///< as shared::PhotonSurface
  uint32_t number = 0;                 ///< k_photon_id_events: of which none is twice
  uint32_t group = 0;                  ///< of its light, where groups are kept apart
  vec3 flux{0};                        ///< [W], of all photons together
};

/// Two maps, of which each is lit by another half of the photons.
struct IrradianceCells {
  std::vector<uvec4> roots;  ///< a triangle each: nodes of front and back in the first map, in the second
  std::vector<vec4> nodes;   ///< shared/photons/irradiance.h, 1 + groups texels each
  uint32_t known = 0;        ///< pieces
};

class IrradianceCellsBuilder {
 public:
  /// `order` outlives it. `groups`: of lights that are kept apart; 0: none are. `nearest`: photons of a half
  /// that a piece has at least. `widest`: about as large may a piece be that is put together [m].
  IrradianceCellsBuilder(const SideOrder& order, std::vector<PhotonOnSide> photons, uint32_t groups,
                         uint32_t nearest, float widest);
  /// Which half of the photons lights it: 0 or 1. Once for each.
  void add_map(uint32_t lit_by);
  IrradianceCells take() { return std::move(cells_); }

 private:
  struct Sum {
    uint32_t deciding = 0;  ///< photons
    double area = 0;
    std::vector<double> flux;  ///< R G B, and by group
    std::vector<uint32_t> nodes;
  };
  struct Rest;
  struct Piece {
    double area = 0, longest = 0;  ///< edge
    uint32_t depth = 0;            ///< cuts
    double expected = 0;           ///< photons that decide, by those of the triangle that it is a quarter of
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
  std::vector<uint32_t> rests_of_;  ///< by place in the order: what is left over there, in rests_
  std::vector<Sum> rests_;
  std::vector<uint32_t> decided_;  ///< photons up to there in the order that are left over
  IrradianceCells cells_;
};

}  // namespace lucerna::photons
