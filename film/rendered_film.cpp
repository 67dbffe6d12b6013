#include "film/rendered_film.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "film/build_id.h"
#include "film/sensor_identity.h"
#include "io/data_directory.h"
#include "io/exr.h"
#include "transport/plan/techniques.h"

namespace abbe {

const char* integrator_name(Integrator integrator) {
  return kIntegratorNames.at(static_cast<std::size_t>(integrator));
}

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
  return identity;
}

std::size_t film_bytes(const Scene& scene, const RenderOptions& how) {
  return bytes_of_sums({.width = scene.camera.width,
                        .height = scene.camera.height,
                        .channels = static_cast<int>(scene.film_planes().size()),
                        .replicates = replicate_count(scene, how),
                        .unit_exponent = 0,
                        .crop = how.crop});
}

void write_film(const std::filesystem::path& path, const RenderPart& part) {
  if (path.extension() == kPartExtension)
    write_part(path, part.identity, part.result, part.areas);
  else
    write_exr(path, film_image(part));
}

}  // namespace abbe
