#include "report/polarisation_difference.h"

#include <algorithm>
#include <cmath>

#include "sensor/film/film_planes.h"

namespace abbe {
namespace {

// Mean and maximum of some numbers; 0 without numbers.
struct MeanAndMax {
  double sum = 0;
  double max = 0;
  double count = 0;

  void add(double value) {
    sum += value;
    max = std::max(max, value);
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
};

double between_planes(double a_deg, double b_deg) {
  const double difference = std::abs(a_deg - b_deg);
  return std::min(difference, 180 - difference);
}

struct DifferenceStatistics {
  MeanAndMax degree;
  MeanAndMax angle_deg;

  void add(const PolarisationFigures& image, const PolarisationFigures& reference) {
    if (reference.degree > kPolarised) degree.add(std::abs(image.degree - reference.degree));
    if (reference.linear_degree > kPolarised)
      angle_deg.add(between_planes(image.angle_deg, reference.angle_deg));
  }
};

}  // namespace

std::optional<PolarisationDifference> polarisation_difference(const Image& image, const Image& reference) {
  const std::vector<StokesPlanes> own = stokes_planes(image);
  DifferenceStatistics statistics;
  double compared = 0;
  for (const StokesPlanes& planes : stokes_planes(reference)) {
    const auto same = std::find_if(own.begin(), own.end(), [&planes](const StokesPlanes& other) {
      return other.channel == planes.channel;
    });
    if (same == own.end()) continue;
    for (std::size_t pixel = 0; pixel < reference.pixels(); ++pixel)
      statistics.add(polarisation_of(same->at(pixel)), polarisation_of(planes.at(pixel)));
    compared += static_cast<double>(reference.pixels());
  }
  if (!(compared > 0)) return std::nullopt;
  return PolarisationDifference{statistics.degree.count / compared, statistics.degree.mean(),
                                statistics.degree.max, statistics.angle_deg.mean(), statistics.angle_deg.max};
}

}  // namespace abbe
