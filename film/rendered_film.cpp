#include "film/rendered_film.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "film/build_id.h"
#include "film/sensor_identity.h"
#include "io/data_directory.h"
#include "io/exr.h"

namespace abbe {

const char* integrator_name(Integrator integrator) {
  constexpr std::array kNames{"auto", "path", "light"};
  return kNames.at(static_cast<std::size_t>(integrator));
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
  identity.merge(sensor_identity(scene));
  if (!how.time_limit_s && !how.target_error)
    identity[kStatedSamplesKey] = fmt::format("{}", scene.render.samples);
  if (how.crop)
    identity["crop"] = fmt::format("{},{},{},{}", how.crop->x0, how.crop->y0, how.crop->x1, how.crop->y1);
  return identity;
}

std::size_t film_bytes(const Scene& scene, const RenderOptions& how) {
  return static_cast<std::size_t>(scene.camera.width) * static_cast<std::size_t>(scene.camera.height) *
         scene.film_planes().size() * static_cast<std::size_t>(replicate_count(scene, how)) * sizeof(Int128);
}

void write_film(const std::filesystem::path& path, const RenderPart& part) {
  if (path.extension() == kPartExtension)
    write_part(path, part.identity, part.result);
  else
    write_exr(path, film_image(part));
}

}  // namespace abbe
