#include "sensor/response/stokes_channels.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace abbe {
namespace {

constexpr std::array<std::string_view, 4> kPrefixes{"", "S1.", "S2.", "S3."};

Analyser analyser_of(int component) {
  return {0, component == 1 ? 1.0F : 0.0F, component == 2 ? 1.0F : 0.0F, component == 3 ? 1.0F : 0.0F};
}

}  // namespace

std::string name_of(const StokesPlane& plane) {
  return fmt::format("{}{}", kPrefixes.at(static_cast<std::size_t>(plane.component)), plane.channel);
}

StokesPlane stokes_plane(std::string_view name) {
  for (int component = 1; component < 4; ++component)
    if (const std::string_view prefix = kPrefixes.at(static_cast<std::size_t>(component));
        name.starts_with(prefix))
      return {component, std::string(name.substr(prefix.size()))};
  return {0, std::string(name)};
}

std::vector<Channel> with_stokes(std::vector<Channel> channels) {
  const std::size_t count = channels.size();
  for (int component = 1; component < 4; ++component)
    for (std::size_t k = 0; k < count; ++k) {
      Channel channel = channels[k];
      channel.name = name_of({component, channel.name});
      channel.analyser = analyser_of(component);
      channels.push_back(std::move(channel));
    }
  return channels;
}

std::size_t count_intensities(std::span<const Channel> channels) {
  return static_cast<std::size_t>(std::count_if(channels.begin(), channels.end(), counts_light));
}

std::vector<Channel> intensities(std::span<const Channel> channels) {
  std::vector<Channel> selected;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(selected), counts_light);
  return selected;
}

std::vector<std::string> intensities(std::span<const std::string> planes) {
  std::vector<std::string> selected;
  std::copy_if(planes.begin(), planes.end(), std::back_inserter(selected),
               [](const std::string& name) { return stokes_plane(name).component == 0; });
  return selected;
}

bool any_analyser(std::span<const Channel> channels) {
  return std::any_of(channels.begin(), channels.end(),
                     [](const Channel& channel) { return channel.analyser.has_value(); });
}

}  // namespace abbe
