#include "cli/film_output.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "cli/film_sensor.h"
#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/error.h"
#include "io/exr.h"

namespace abbe::cli {

FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                         const abbe::RenderOptions& how) {
  constexpr std::array kIntegrators{"auto", "path", "light"};
  std::string name = scene_file.filename().string();
  std::replace(name.begin(), name.end(), '\n', '?');  // headers have a line per entry
  FilmIdentity identity{
      {"version", ABBE_VERSION},
      {"scene", name},
      {"scene_sha256", scene.sha256},
      {"data_sha256", data_sha256()},
      {"seed", fmt::format("{}", scene.render.seed)},
      {"integrator", kIntegrators.at(static_cast<std::size_t>(scene.render.integrator))},
      {"replicates", fmt::format("{}", replicate_count(scene, how))},
  };
  identity.merge(sensor_identity(scene));
  if (how.crop)
    identity["crop"] = fmt::format("{},{},{},{}", how.crop->x0, how.crop->y0, how.crop->x1, how.crop->y1);
  return identity;
}

void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed) {
  const auto same = [&path](const char* extension) { return path.extension() == extension; };
  if (std::none_of(allowed.begin(), allowed.end(), same))
    throw Error(
        ErrorCode::usage, path.string(),
        fmt::format("got extension \"{}\", allowed {}", path.extension().string(), fmt::join(allowed, ", ")));
}

void require_distinct(std::span<const std::filesystem::path> files) {
  std::map<std::filesystem::path, std::filesystem::path> names;
  for (const std::filesystem::path& file : files) {
    if (file.empty()) continue;
    const auto [there, added] = names.emplace(weakly_canonical(absolute(destination(file))), file);
    if (!added)
      throw Error(ErrorCode::usage, file.string(),
                  fmt::format("is the same file as {}: each needs one of its own", there->second.string()));
  }
}

void require_film_output(const std::filesystem::path& path) {
  require_extension(path, {".exr", kPartExtension});
  require_writable(path);
}

void write_film(const std::filesystem::path& path, const RenderPart& part) {
  if (path.extension() == kPartExtension)
    write_part(path, part.identity, part.result);
  else
    write_exr(path, film_image(part));
}

}  // namespace abbe::cli
