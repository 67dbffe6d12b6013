#include "film/rendered_film.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "film/build_id.h"
#include "film/sensor_identity.h"
#include "io/data_directory.h"
#include "io/exr.h"
#include "io/extension.h"
#include "transport/plan/techniques.h"

namespace abbe {
namespace {

constexpr std::size_t kMostShapes = 1024;

// What features are told, and by what names the shapes go that ids are numbers of.
void add_features(const Scene& scene, const std::vector<Feature>& features, FilmIdentity& identity) {
  identity[kFeaturesKey] = to_text(features);
  const bool ids = std::find(features.begin(), features.end(), Feature::id) != features.end();
  if (!ids || scene.shapes.size() > kMostShapes) return;
  using Json = nlohmann::ordered_json;
  Json names = Json::array();
  for (const ShapeInstance& shape : scene.shapes) names.push_back(shape.name);
  // Mesh files may name their materials by any bytes.
  identity[kShapeNamesKey] = names.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                         const RenderOptions& how) {
  std::string name = scene_file.filename().string();
  std::replace(name.begin(), name.end(), '\n', '?');  // headers have a line per entry
  FilmIdentity identity{
      {"version", ABBE_VERSION},
      {kBuildKey, build_id()},
      {kInstructionSetKey, instruction_set()},
      {"scene", name},
      {"scene_sha256", scene.sha256},
      {"data_sha256", data_sha256()},
      {"seed", fmt::format("{}", scene.render.seed)},
      {"integrator", integrator_name(scene.render.integrator)},
      {"replicates", fmt::format("{}", replicate_count(scene, how))},
  };
  const std::string_view bias = bias_of(chosen_techniques(scene).front());
  if (!bias.empty()) identity["bias"] = bias;
  identity.merge(sensor_identity(scene));
  if (!how.time_limit_s && !how.target_error)
    identity[kStatedSamplesKey] = fmt::format("{}", scene.render.samples);
  if (how.crop && *how.crop != Crop{0, 0, scene.camera.width, scene.camera.height})
    identity[kCropKey] = to_text(*how.crop);
  if (how.layers) identity[kLayersKey] = fmt::format("{}", fmt::join(how.layers->names, ","));
  if (!how.features.empty()) add_features(scene, how.features, identity);
  return identity;
}

std::size_t film_bytes(const Scene& scene, const RenderOptions& how) {
  const FilmShape shape{.width = scene.camera.width,
                        .height = scene.camera.height,
                        .channels = static_cast<int>(scene.film_planes().size()),
                        .replicates = replicate_count(scene, how),
                        .unit_exponent = 0,
                        .crop = how.crop};
  return bytes_of_sums(shape) + (how.layers ? bytes_of_sums(layered(shape, how.layers->names.size())) : 0) +
         bytes_of_features(how.features, shape, scene.film_planes());
}

void write_film(const std::filesystem::path& path, const RenderPart& part) {
  if (extension_of(path) == kPartExtension)
    write_part(path, part.identity, part.result, part.areas);
  else
    write_exr(path, film_image(part));
}

}  // namespace abbe
