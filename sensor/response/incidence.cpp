#include "sensor/response/incidence.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace abbe {
namespace {

// Transmittance at an angle of incidence: T(lambda / blue_shift).
Curve shifted(const InterferenceFilter& filter, double cos_film) {
  const double shift = blue_shift(cos_film, filter.effective_index);
  std::vector<Knot> knots(filter.transmittance.knots().begin(), filter.transmittance.knots().end());
  for (Knot& knot : knots) knot.wavelength_nm *= shift;
  return Curve(std::move(knots));
}

// Transmittance of all filters at an angle of incidence.
Curve shifted(const std::vector<InterferenceFilter>& filters, double cos_film) {
  Curve all = shifted(filters.front(), cos_film);
  for (std::size_t i = 1; i < filters.size(); ++i) all = product(all, shifted(filters[i], cos_film));
  return all;
}

// Mean transmittance over the angles. Adds by recursive halving, so that few knots are copied often.
Curve mean_transmittance(const std::vector<InterferenceFilter>& filters, std::span<const Incidence> angles) {
  if (angles.size() == 1) return scaled(shifted(filters, angles.front().cos_film), angles.front().fraction);
  const std::size_t half = angles.size() / 2;
  return sum(mean_transmittance(filters, angles.first(half)),
             mean_transmittance(filters, angles.subspan(half)));
}

}  // namespace

Channel averaged(Channel channel, std::span<const Incidence> angles) {
  if (!channel.angular) return channel;
  const FilterStack& filters = channel.angular->filters;
  channel.weight = product(filters.fixed, mean_transmittance(filters.shifting, angles));
  channel.angular.reset();
  return channel;
}

bool any_angular(std::span<const Channel> channels) {
  return std::any_of(channels.begin(), channels.end(),
                     [](const Channel& c) { return c.angular.has_value(); });
}

}  // namespace abbe
