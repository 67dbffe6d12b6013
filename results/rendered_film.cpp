#include "results/rendered_film.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "io/data_directory.h"
#include "io/exr.h"
#include "io/text.h"
#include "results/build_id.h"
#include "results/film_attributes.h"
#include "transport/plan/techniques.h"

namespace abbe {
namespace {

constexpr std::size_t kMaxShapes = 1024;

// Records the features, and the names of the shapes that ids refer to.
void add_features(const Scene& scene, const std::vector<Feature>& features, FilmIdentity& identity) {
  identity[kFeaturesKey] = to_text(features);
  const bool ids = std::find(features.begin(), features.end(), Feature::id) != features.end();
  if (!ids || scene.shapes.size() > kMaxShapes) return;
  using Json = nlohmann::ordered_json;
  Json names = Json::array();
  for (const ShapeInstance& shape : scene.shapes) names.push_back(shape.name);
  // Material names of mesh files may contain any bytes.
  identity[kShapeNamesKey] = names.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                         const RenderOptions& options) {
  std::string name = scene_file.filename().string();
  std::replace(name.begin(), name.end(), '\n', '?');  // metadata have one line per entry
  FilmIdentity identity{
      {"version", ABBE_VERSION},
      {kBuildKey, build_id()},
      {kInstructionSetKey, instruction_set()},
      {"scene", name},
      {"scene_sha256", scene.sha256},
      {"data_sha256", data_sha256()},
      {"seed", fmt::format("{}", scene.render.seed)},
      {"integrator", integrator_name(scene.render.integrator)},
      {"replicates", fmt::format("{}", replicate_count(scene, options))},
  };
  const std::string_view bias = bias_of(chosen_techniques(scene).front());
  if (!bias.empty()) identity["bias"] = bias;
  identity.merge(film_attributes(scene));
  if (!options.time_limit_s && !options.target_error)
    identity[kStatedSamplesKey] = fmt::format("{}", scene.render.samples);
  if (options.crop && *options.crop != Crop{0, 0, scene.camera.width, scene.camera.height})
    identity[kCropKey] = to_text(*options.crop);
  if (options.layers) identity[kLayersKey] = fmt::format("{}", fmt::join(options.layers->names, ","));
  if (!options.features.empty()) add_features(scene, options.features, identity);
  return identity;
}

std::size_t film_bytes(const Scene& scene, const RenderOptions& options) {
  const FilmShape shape{.width = scene.camera.width,
                        .height = scene.camera.height,
                        .channels = static_cast<int>(scene.film_planes().size()),
                        .replicates = replicate_count(scene, options),
                        .unit_exponent = 0,
                        .crop = options.crop};
  return bytes_of_sums(shape) +
         (options.layers ? bytes_of_sums(layered(shape, options.layers->names.size())) : 0) +
         bytes_of_features(options.features, shape, scene.film_planes());
}

void write_film(const std::filesystem::path& path, const RenderPart& part) {
  if (extension_of(path) == kPartExtension)
    write_part(path, part.identity, part.result, part.areas);
  else
    write_exr(path, film_image(part));
}

}  // namespace abbe
