#include "results/field_response.h"

#include "calibration/chart/patches.h"
#include "io/error.h"
#include "results/film_attributes.h"
#include "scene/camera/camera.h"
#include "scene/colors.h"
#include "sensor/response/stokes_channels.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

constexpr int kDistances = 9;  // from the centre to the corner

// The channels at a film position. `distance` is 0 at the centre of the film and 1 at its lower right corner.
// If no light arrives there, the channels at the centre.
std::vector<Channel> channels_at(const Scene& scene, double distance) {
  if (!any_angular(scene.channels)) return scene.channels;
  const auto along = [distance](int size) { return static_cast<float>(size * (1 + distance) / 2); };
  const std::vector<Incidence> angles =
      incidence_angles(scene.camera, {along(scene.camera.width), along(scene.camera.height)});
  if (angles.empty()) return distance == 0 ? scene.channels : channels_at(scene, 0);
  std::vector<Channel> channels = scene.channels;
  for (Channel& channel : channels) channel = averaged(std::move(channel), angles);
  return channels;
}

}  // namespace

std::vector<Channel> channels_at_center(const Scene& scene) {
  return channels_at(scene, 0);
}

std::optional<WhiteField> white_field(const Scene& scene) {
  if (scene.spectral || !has_colors(scene) || !any_angular(scene.channels)) return std::nullopt;
  const std::optional<Curve> light = white_of(scene).spectrum;
  if (!light) return std::nullopt;
  WhiteField field;
  for (int i = 0; i < kDistances; ++i) {
    const std::vector<Channel> channels =
        intensities(channels_at(scene, i / static_cast<double>(kDistances - 1)));
    std::vector<double>& values = field.relative.emplace_back();
    for (const Channel& channel : channels) {
      values.push_back(sum_product(*light, channel.weight, sensed(channels)));
      if (!(values.back() > 0)) return std::nullopt;
    }
  }
  const std::vector<double> center = field.relative.front();
  for (std::vector<double>& values : field.relative)
    for (std::size_t k = 0; k < values.size(); ++k) values[k] /= center[k];
  return field;
}

std::optional<double> neutral_shift(const Scene& scene) {
  const std::optional<WhiteField> field = white_field(scene);
  if (!field) return std::nullopt;
  try {
    return neutral_shift(*field, display_of(scene).to_xyz_d65());
  } catch (const Error& error) {
    if (error.code != ErrorCode::usage) throw;
    return std::nullopt;  // these channels have no pictures
  }
}

}  // namespace abbe
