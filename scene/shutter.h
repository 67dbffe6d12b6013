#pragma once

#include <vector>

namespace abbe {

/// When the rows of a film are open to light, and how far. Each row is open for the exposure time T, the
/// first from time 0 and every other one a delay later than that above it, so that the whole film is exposed
/// over the span T + (rows - 1) delay, of which times are shares. A row that has been open for the share s of
/// T passes the share S(s) of the light, and what it collects of an irradiance E is the integral of S E over
/// time.
class Shutter {
 public:
  /// The share that passes when the share `at` of the exposure has gone by; straight lines lead from one to
  /// the next.
  struct Knot {
    double at = 0;
    double passes = 1;
  };

  /// All rows at once, wide open for all of the exposure.
  Shutter() = default;
  /// Knots from 0 to 1 in order, of which some pass light; `delay` is that of a row, as a share of the
  /// exposure.
  Shutter(std::vector<Knot> knots, double delay, int rows);

  /// The mean of S: what the exposure time is multiplied by where nothing changes while it lasts.
  [[nodiscard]] double mean() const { return mean_; }
  /// The span over the exposure time.
  [[nodiscard]] double span() const { return span_; }
  /// A time at which light comes to the row, drawn with the density of what passes: what is found then counts
  /// `mean`, whenever that is. `u` in [0, 1).
  [[nodiscard]] float draw(int row, float u) const { return plain_ ? u : draw_in(row, u); }
  /// What light that comes to the row at that time counts, the time being one of all those of the span, each
  /// as likely as any other: S over the share of the span that a row is open.
  [[nodiscard]] float weight(int row, float time) const {
    return plain_ ? static_cast<float>(mean_) : weight_in(row, time);
  }

  /// The shutter of a scene in which nothing moves: it only passes the mean of what it does.
  [[nodiscard]] Shutter where_nothing_moves() const;

 private:
  [[nodiscard]] float draw_in(int row, float u) const;
  [[nodiscard]] float weight_in(int row, float time) const;

  std::vector<Knot> knots_ = {{0, 1}, {1, 1}};
  std::vector<double> passed_ = {0, 1};  // by each knot, of all that passes
  double mean_ = 1;
  double delay_ = 0;
  double span_ = 1;
  bool plain_ = true;  // wide open, or as good as that, for all rows at once
};

}  // namespace abbe
