// A line and the faces that it meets, contact by contact: what a LineScan holds.
// line_scan.cpp finds the faces, judgement.cpp says which contacts block.

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/contacts/obstacles.h"

namespace sightline::internal::contacts {

/// One face's part in a contact.  Rays and positions are numbers into Scan.
struct Hit {
  int face;
  TouchKind kind;
  Obstacle obstacle;
  int index = -1;
  int from, to;
  int start = -1, end = -1;  // Sector: counter-clockwise from start, at most a half turn
  // In a plane with L: where the ids of its corners begin, and which of them is at
  // `from`, or begins the side that is.
  int loop = -1, from_at = -1;
};

/// A position x = num / den along L, den > 0.
struct Position {
  Ring num, den;
  double approx = 0;
  std::optional<Rational> t;
};

/// The rounded line for the first stage: |a - line a| <= a_error, direction scaled to
/// about 1 with an error of at most 2 ulp of its largest component.
struct RoundedLine {
  double a[3], d[3];
  double a_error;  // largest error of a coordinate of a
  bool usable;
};

struct Scan {
  // ---- The line. ----
  const Scene* scene = nullptr;
  Ring alpha, origin[3], direction[3];
  bool alpha_is_one = true;
  Gmpq scale;            // delta / alpha
  double rounded_scale;  // within 2 ulp
  int k = 0;
  RoundedLine rounded;

  // ---- What it meets. ----
  std::vector<Corner> corners;
  mutable std::vector<Position> positions;
  std::vector<Hit> hits;                             // by position `from` once sorted
  std::vector<int> first_hit;                        // of each contact, and the end
  std::vector<int> contact_to;                       // position
  mutable std::vector<std::optional<bool>> blocked;  // of each contact, once asked
  std::vector<int> loops;  // corner ids of faces in a plane with L, face by face
  // Scratch of the first stage, per corner of a face.
  std::vector<double> u_scratch;
  std::vector<std::int8_t> signs;

  // ---- line_scan.cpp ----
  void set_line(const Point& a, const Point& b);
  void set_line(const ExactPoint& a, const ExactPoint& b);
  void round_line(const double* a, const double* d, double a_relative_error);
  // Meets all faces and groups what they are met in.
  void scan(std::span<const int> faces);

  [[nodiscard]] Corner seen(int point, const Point& p) const;
  int corner(int point);  // its number, seen before or not
  int corner_position(int corner_id);
  int edge_position(int p, int q);
  int plane_position(std::span<const int> points);
  int add_position(Ring num, Ring den) const;
  int compare(int p, int q) const;
  [[nodiscard]] Rational quotient_times_scale(const Ring& num, const Ring& den) const;
  const Rational& t(int position) const;
  [[nodiscard]] int t_against(int position, int s) const;

  bool first_stage(std::span<const int> points);
  void meet(int face);
  void meet_in_plane(int face, std::span<const int> ids);
  [[nodiscard]] bool is_diagonal(int face, int side) const;
  void group();
  // ---- judgement.cpp ----
  [[nodiscard]] Rational corner_t(const Corner& c) const;
  [[nodiscard]] int compare_slopes(const Corner& p, const Corner& q, int position) const;
  void add_fins(const Hit& hit, const Rational* lo, const Rational* hi,
                std::vector<Fin>& fins) const;
  [[nodiscard]] std::span<const Hit> hits_of(int contact) const {
    return {hits.data() + first_hit[contact], hits.data() + first_hit[contact + 1]};
  }
  // The order of the slopes of two sides that begin at a position.
  [[nodiscard]] auto slope_order(int position) const {
    return [this, position](const Corner& p, const Corner& q) {
      return compare_slopes(p, q, position);
    };
  }
  [[nodiscard]] bool blocks(int contact) const;
  bool judge(int contact, const Rational* lo, const Rational* hi,
             const std::function<bool(int)>* solid_behind = nullptr) const;

  // An obstacle at a position, its sides along corners.
  struct Material {
    int position;
    Corner start, end;  // counter-clockwise, at most a half turn
  };
  [[nodiscard]] std::vector<Material> material_at_ends(
      int contact, const Rational& lo, const Rational& hi,
      const std::function<bool(int)>& solid_behind) const;
  void add_material(int contact, const Rational& t,
                    const std::function<bool(int)>& solid_behind,
                    std::vector<Material>& out) const;

  // The sectors of a contact, in order along L, and the position of each.
  struct Sectors {
    std::vector<SectorAt> sectors;
    std::vector<int> at;
  };
  void add_sector(int position, const Corner* start, const Corner* end,
                  Sectors& out) const;
  [[nodiscard]] bool add_sectors(int contact, const Rational* lo, const Rational* hi,
                                 std::span<const Material> material, Sectors& out) const;
  [[nodiscard]] bool block_at_once(std::span<const SectorAt> now, int position) const;
  void add_rays(std::span<const SectorAt> now, int position,
                std::vector<const Ray*>& rays) const;
};

}  // namespace sightline::internal::contacts
